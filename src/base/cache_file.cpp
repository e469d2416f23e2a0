#include "base/cache_file.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/atomic_file.h"

namespace microinjection {
namespace {

std::string header(const std::string& description, const std::string& body) {
  return description + " checksum " + contentHash(body) + '\n';
}

}  // namespace

std::string cacheDirectory(const std::string& below) {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::string folder = "cell_microinjection/" + below;
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/" + folder;  // the standard ignores others
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
  writeFileAtomically(path, header(description, body) + body);
}

std::optional<std::string> readCacheFile(const std::string& path, const std::string& description) {
  std::ifstream file(path, std::ios::binary);
  std::string first;
  if (!file || !std::getline(file, first)) return std::nullopt;
  std::string body((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (first + '\n' != header(description, body)) return std::nullopt;
  return body;
}

}  // namespace microinjection
