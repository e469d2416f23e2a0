#include "base/cache_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "base/atomic_file.h"

namespace microinjection {
namespace {

constexpr char kChecksum[] = " checksum ";

std::string header(const std::string& description, const std::string& body) {
  return description + kChecksum + contentHash(body) + '\n';
}

/// Owns the descriptor that open() returned; -1 for none.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// Returns errno when reading fails, nothing when the whole file was read.
std::optional<int> readAll(int file, std::string& content) {
  char block[65536];
  for (;;) {
    const ssize_t count = ::read(file, block, sizeof(block));
    if (count == 0) return std::nullopt;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    content.append(block, static_cast<std::size_t>(count));
  }
}

CacheRead<std::string> failed(CacheState state, const std::string& path, const std::string& reason) {
  return {std::nullopt, state, path + ": " + reason};
}

CacheRead<std::string> unreadable(const std::string& path, int error) {
  if (error == ENOENT) return failed(CacheState::kMissing, path, "does not exist");
  // open() fails with ENXIO on a socket.
  if (error == ENXIO) return failed(CacheState::kNotRegular, path, "is not a regular file");
  return failed(CacheState::kUnreadable, path, std::string("cannot be read: ") + std::strerror(error));
}

}  // namespace

std::string cacheDirectory(const std::string& below) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::string folder = "cell_microinjection/" + below;
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/" + folder;  // XDG ignores relative paths
  if (home != nullptr && home[0] != '\0') return std::string(home) + "/.cache/" + folder;
  return "";
}

std::string contentHash(const std::string& text) {  // FNV-1a
  std::uint64_t value = 14695981039346656037ull;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  std::ostringstream out;
  out << std::hex << value;
  return out.str();
}

void writeCacheFile(const std::string& path, const std::string& description, const std::string& body) {
  replaceFileAtomically(path, header(description, body) + body);
}

CacheRead<std::string> readCacheFile(const std::string& path, const std::string& description) {
  // Without O_NONBLOCK, opening a pipe would wait for a writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  struct stat kind {};
  if (file.number() < 0 || ::fstat(file.number(), &kind) != 0) return unreadable(path, errno);
  if (!S_ISREG(kind.st_mode)) return failed(CacheState::kNotRegular, path, "is not a regular file");
  std::string content;
  if (const auto error = readAll(file.number(), content)) return unreadable(path, *error);

  const std::size_t end = content.find('\n');
  if (end == std::string::npos) return damagedCache<std::string>(path, "its header is not whole");
  const std::string first = content.substr(0, end + 1), body = content.substr(end + 1);
  if (first == header(description, body)) return {body, CacheState::kRead, ""};
  const std::size_t checksum = first.rfind(kChecksum);
  if (checksum == std::string::npos || first != header(first.substr(0, checksum), body)) {
    return damagedCache<std::string>(path, "its checksum is not that of its content");
  }
  return failed(CacheState::kOther, path, "was written by another version of the program, or for something else");
}

}  // namespace microinjection
