#pragma once

#include "operation/console/light.h"
#include "operation/console/session_view.h"

namespace microinjection {

/// The line that says what the session does or what it waits for, with its lamp: red for FAULT and a
/// silent controller, yellow for whatever holds the needle or refused the last command, green while
/// the needle moves or may move, grey while DISABLED. Where the needle is not led it also says what to mend first.
Lamp headline(const SessionView& session);

}  // namespace microinjection
