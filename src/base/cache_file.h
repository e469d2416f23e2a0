#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// cell_microinjection/`below` in $XDG_CACHE_HOME or else ~/.cache; empty when neither variable is set. A relative
/// $XDG_CACHE_HOME counts as not set, as the XDG base directory specification has it.
std::string cacheDirectory(const std::string& below);

/// 64-bit hash (FNV-1a) as hexadecimal text, the same on every machine. It names files and detects damage. It does not
/// protect against malice, and a cache in the user's own folder need not do so.
std::string contentHash(const std::string& text);

enum class CacheState {
  kRead,
  kMissing,     ///< there is no file
  kNotRegular,  ///< a pipe, device or directory; it is not opened, because opening could block
  kUnreadable,  ///< the system refuses to read it
  kDamaged,     ///< truncated, changed since it was written, or with invalid content
  kOther        ///< valid, but of another description
};

/// Content of a cache file, or the reason why it cannot be used. Reading does not throw, because a file that is
/// missing, damaged or of another version is nothing exceptional in a cache: the caller makes the content anew, or
/// tells the user how to, and decides by `state`.
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

/// Stores `body` such that readCacheFile returns it for the same `description` only:
///
///     DESCRIPTION checksum HASH    one line; HASH: contentHash(BODY)
///     BODY                         any bytes
///
/// The description says what the body was computed from, with the version of the computation. It is in the file in
/// full, although most file names have its hash already, so that a reader can tell a file of another version, which is
/// to be made anew, from a damaged one, and so that two descriptions of one hash are never confused. The checksum finds
/// what the atomic replacement cannot prevent, such as a copy that was cut short.
///
/// Safe with concurrent readers and writers of the file. Throws WriteError as replaceFileAtomically does.
/// @pre `description` has no line break: the file would read as damaged
void writeCacheFile(const std::string& path, const std::string& description, const std::string& body);

/// The body that was stored for `description`. Reads regular files only and never blocks, also where a pipe lies at
/// `path`. The whole file is read into memory.
CacheRead<std::string> readCacheFile(const std::string& path, const std::string& description);

}  // namespace microinjection
