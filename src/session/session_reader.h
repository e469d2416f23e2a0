#pragma once

#include <optional>
#include <string>

#include "base/config_reader.h"
#include "session/session.h"

namespace microinjection {

/// A session while its files and its arguments are read, each over the ones before.
struct SessionDraft {
  Session session;
  /// No value: `auto`, which follows from other keys.
  std::optional<bool> allow_network, auto_enable, start_when_enabled, link_emulated;

  /// Without a file: the values of config/sessions/default.yaml.
  explicit SessionDraft(const std::string& package);
};

/// Sets the keys that one file, or the arguments, have. Relative paths are meant from `folder`. Errors go to the
/// reader.
void readSessionKeys(ConfigReader& reader, const std::string& folder, SessionDraft& draft);

/// Puts values in the place of `auto`.
Session resolved(SessionDraft draft);

}  // namespace microinjection
