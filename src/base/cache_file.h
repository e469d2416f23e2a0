#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// cell_microinjection/`below` in $XDG_CACHE_HOME or else ~/.cache; empty when neither variable is
/// set.
std::string cacheDirectory(const std::string& below);

/// 64-bit hash as hexadecimal text. It names files and detects damage. It does not protect against
/// malice.
std::string contentHash(const std::string& text);

enum class CacheState {
  kRead,
  kMissing,     ///< there is no file
  kNotRegular,  ///< a pipe, device or directory; it is not opened, because opening could block
  kUnreadable,  ///< the system refuses to read it
  kDamaged,     ///< truncated, changed since it was written, or with invalid content
  kOther        ///< valid, but of another description
};

/// Content of a cache file, or the reason why it cannot be used.
template <typename Content>
struct CacheRead {
  std::optional<Content> content;  ///< of kRead only
  CacheState state = CacheState::kMissing;
  std::string reason;  ///< of all other states: one line that names the file

  explicit operator bool() const { return content.has_value(); }

  /// The same failure for a reader of another type.
  template <typename Other>
  CacheRead<Other> failure() const {
    return {std::nullopt, state, reason};
  }
};

/// Result for a file with a valid checksum whose content the reader rejects for `reason`.
template <typename Content>
CacheRead<Content> damagedCache(const std::string& path, const std::string& reason) {
  return {std::nullopt, CacheState::kDamaged, path + ": is damaged: " + reason};
}

/// Stores `body` such that readCacheFile returns it for the same `description` (one line of text)
/// only. Safe with concurrent readers and writers of the file. Throws WriteError as
/// replaceFileAtomically does.
void writeCacheFile(const std::string& path, const std::string& description, const std::string& body);

/// The body that was stored for `description`. Reads regular files only and never blocks.
CacheRead<std::string> readCacheFile(const std::string& path, const std::string& description);

}  // namespace microinjection
