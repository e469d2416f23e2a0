#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// $XDG_CACHE_HOME or else ~/.cache, and there cell_microinjection/`below`; empty when neither variable is set.
std::string cacheDirectory(const std::string& below);

/// 64 bit as hexadecimal text: to name files and to notice damage, not against malice.
std::string contentHash(const std::string& text);

/// Stores `body` so that readCacheFile gives it back for the same `description` (one line of text) only. Safe against
/// readers and other writers of the same file. Throws std::runtime_error as writeFileAtomically.
void writeCacheFile(const std::string& path, const std::string& description, const std::string& body);

/// The body; nothing when there is no file, or it is torn, damaged or of another description.
std::optional<std::string> readCacheFile(const std::string& path, const std::string& description);

}  // namespace microinjection
