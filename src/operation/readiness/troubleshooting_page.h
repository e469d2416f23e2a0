#pragma once

namespace microinjection {

/// doc/guide/troubleshooting.md.
const char* troubleshootingPage();

}  // namespace microinjection
