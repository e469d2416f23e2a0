#include "base/text_lines.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string bytesOf(const std::string& path, std::vector<std::string>& notes) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw ConfigError(path + ": is a folder, must be a file");
  const gzFile file = ::gzopen(path.c_str(), "rb");  // also of files that are not compressed
  if (!file) throw ConfigError(path + ": cannot be read: " + std::strerror(errno));
  std::string bytes, block(1 << 20, '\0');
  int count = 0;
  while ((count = ::gzread(file, block.data(), static_cast<unsigned>(block.size()))) > 0)
    bytes.append(block, 0, static_cast<std::size_t>(count));
  if (::gzdirect(file) == 0) notes.emplace_back("the file is compressed (gzip)");
  // A compressed file that is cut off is an error when it is closed.
  if (::gzclose(file) != Z_OK || count < 0) throw ConfigError(path + ": is damaged, or cannot be read to its end");
  return bytes;
}

void append(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += {static_cast<char>(0xC0 | code >> 6), static_cast<char>(0x80 | (code & 0x3F))};
  } else if (code < 0x10000) {
    text += {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3F)),
             static_cast<char>(0x80 | (code & 0x3F))};
  } else {
    text += {static_cast<char>(0xF0 | code >> 18), static_cast<char>(0x80 | (code >> 12 & 0x3F)),
             static_cast<char>(0x80 | (code >> 6 & 0x3F)), static_cast<char>(0x80 | (code & 0x3F))};
  }
}

std::string fromUtf16(const std::string& bytes, bool big_endian) {
  std::string text;
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code == 0xFEFF) continue;
    if (code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size()) {
      i += 2;
      code = 0x10000 + ((code - 0xD800) << 10) + (unit(i) - 0xDC00);
    }
    append(text, code);
  }
  return text;
}

/// Whether UTF-16 without a mark: every second byte of a text in a European language is 0.
bool looksLikeUtf16(const std::string& bytes, bool big_endian) {
  const std::size_t count = std::min<std::size_t>(bytes.size() / 2, 200);
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < count; ++i) zeros += bytes[2 * i + (big_endian ? 0 : 1)] == '\0' ? 1 : 0;
  return count > 0 && zeros > 0.7 * static_cast<double>(count);
}

bool isUtf8(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) continue;
    const int more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC2 ? 1 : 0;
    if (more == 0) return false;
    for (int k = 0; k < more; ++k) {
      if (++i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return false;
    }
  }
  return true;
}

std::string toUtf8(const std::string& bytes, std::vector<std::string>& notes) {
  const bool little = bytes.rfind("\xFF\xFE", 0) == 0, big = bytes.rfind("\xFE\xFF", 0) == 0;
  if (little || big || looksLikeUtf16(bytes, false) || looksLikeUtf16(bytes, true)) {
    notes.emplace_back("the file is in UTF-16");
    return fromUtf16(bytes, big || (!little && looksLikeUtf16(bytes, true)));
  }
  if (bytes.rfind("\xEF\xBB\xBF", 0) == 0) return bytes.substr(3);
  if (isUtf8(bytes)) return bytes;
  notes.emplace_back("the file is not in UTF-8; it is read as Latin-1");
  std::string text;
  for (const char byte : bytes) append(text, static_cast<unsigned char>(byte));
  return text;
}

}  // namespace

std::vector<std::string> readTextLines(const std::string& path, std::vector<std::string>& notes) {
  const std::string text = toUtf8(bytesOf(path, notes), notes);
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    const std::size_t zero = lines.back().find('\0');
    if (zero != std::string::npos)
      throw ConfigError(path + ", line " + std::to_string(lines.size()) + ": has a NUL byte: must be a text file");
    begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
  }
  return lines;
}

}  // namespace microinjection
