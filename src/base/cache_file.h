#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// $XDG_CACHE_HOME or else ~/.cache, and there cell_microinjection/`below`; empty when neither variable is set.
std::string cacheDirectory(const std::string& below);

/// 64 bit as hexadecimal text: to name files and to notice damage, not against malice.
std::string contentHash(const std::string& text);

enum class CacheState {
  kRead,
  kMissing,     ///< there is no file
  kNotRegular,  ///< a pipe, a device, a directory: never opened for waiting
  kUnreadable,  ///< for the system's reason
  kDamaged,     ///< torn, changed since it was written, or with content that cannot be
  kOther        ///< whole, but of another description
};

/// What a file of a cache holds, or why that cannot be used.
template <typename Content>
struct CacheRead {
  std::optional<Content> content;  ///< of kRead only
  CacheState state = CacheState::kMissing;
  std::string reason;  ///< of all others: one line that names the file

  explicit operator bool() const { return content.has_value(); }

  /// The same failure of a reader of something else.
  template <typename Other>
  CacheRead<Other> failure() const {
    return {std::nullopt, state, reason};
  }
};

/// Whole, but with content that its reader cannot use, for the given reason.
template <typename Content>
CacheRead<Content> damagedCache(const std::string& path, const std::string& reason) {
  return {std::nullopt, CacheState::kDamaged, path + ": is damaged: " + reason};
}

/// Stores `body` so that readCacheFile gives it back for the same `description` (one line of text) only. Safe against
/// readers and other writers of the same file. Throws WriteError as replaceFileAtomically.
void writeCacheFile(const std::string& path, const std::string& description, const std::string& body);

/// The body that was stored for `description`. Reads regular files only and never waits.
CacheRead<std::string> readCacheFile(const std::string& path, const std::string& description);

}  // namespace microinjection
