#include "vision/camera/tiff_pages.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>

namespace microinjection {
namespace {

constexpr int kSubfile = 254, kBits = 258, kPhotometric = 262, kDescription = 270, kSampleFormat = 339;  // tags
constexpr std::uint64_t kReduced = 1, kMask = 4;                                                         // of kSubfile
constexpr std::uint64_t kShort = 3, kLongestText = 4096;
constexpr std::size_t kMostPages = 100000;
constexpr std::uint64_t kMostEntries = 4096;  // of a directory

/// Reads the numbers of a file in its own byte order. What is beyond the end reads as 0, and ok() is false then.
class TiffReader {
 public:
  explicit TiffReader(const std::string& path) : file_(path, std::ios::binary) {
    char order[2] = {};
    file_.read(order, 2);
    big_endian_ = order[0] == 'M' && order[1] == 'M';
    if (!big_endian_ && (order[0] != 'I' || order[1] != 'I')) return;
    const std::uint64_t version = number(2, 2);
    big_ = version == 43;
    is_tiff_ = ok() && (version == 42 || big_);
  }

  bool isTiff() const { return is_tiff_; }
  bool ok() const { return file_.good(); }
  std::uint64_t number(std::uint64_t place, int bytes) {
    unsigned char raw[8] = {};
    file_.seekg(static_cast<std::streamoff>(place));
    file_.read(reinterpret_cast<char*>(raw), bytes);
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | raw[big_endian_ ? i : bytes - 1 - i];
    return value;
  }
  std::string text(std::uint64_t place, std::uint64_t length) {
    std::string text(std::min(length, kLongestText), '\0');
    file_.seekg(static_cast<std::streamoff>(place));
    file_.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
  }

  int offsetBytes() const { return big_ ? 8 : 4; }
  int countBytes() const { return big_ ? 8 : 2; }  ///< of a directory's entries
  int entryBytes() const { return big_ ? 20 : 12; }
  std::uint64_t firstDirectory() { return number(big_ ? 8 : 4, offsetBytes()); }

 private:
  std::ifstream file_;
  bool is_tiff_ = false, big_endian_ = false, big_ = false;
};

/// Images that the description of ImageJ counts. It writes one directory for a stack of more than 4 GB.
std::size_t describedImages(const std::string& text) {
  const std::size_t place = text.find("\nimages=");
  if (text.rfind("ImageJ=", 0) != 0 || place == std::string::npos) return 0;
  return std::strtoul(text.c_str() + place + 8, nullptr, 10);
}

/// @param entry  of a tag
void readTag(TiffReader& file, std::uint64_t entry, TiffPage& page, std::uint64_t& subfile) {
  const std::uint64_t tag = file.number(entry, 2), type = file.number(entry + 2, 2);
  const std::uint64_t count = file.number(entry + 4, file.offsetBytes());
  const std::uint64_t value = entry + 4 + static_cast<unsigned>(file.offsetBytes());
  // The first value: it is in the entry, unless all of them together are too long for it.
  const int bytes = type == kShort ? 2 : 4;
  const bool within = count * static_cast<unsigned>(bytes) <= static_cast<unsigned>(file.offsetBytes());
  const auto first = [&] { return file.number(within ? value : file.number(value, file.offsetBytes()), bytes); };
  if (tag == kSubfile) subfile = first();
  if (tag == kBits) page.bits = static_cast<unsigned>(first());
  if (tag == kPhotometric) page.min_is_white = first() == 0;
  if (tag == kSampleFormat) page.sample_format = static_cast<unsigned>(first());
  if (tag == kDescription && count > 8)
    page.described = describedImages(file.text(file.number(value, file.offsetBytes()), count));
}

}  // namespace

std::optional<std::vector<TiffPage>> tiffPages(const std::string& path) {
  TiffReader file(path);
  if (!file.isTiff()) return std::nullopt;
  std::vector<TiffPage> pages;
  std::set<std::uint64_t> seen;
  std::uint64_t directory = file.firstDirectory();
  for (std::size_t number = 0; directory != 0 && number < kMostPages; ++number) {
    if (!file.ok() || !seen.insert(directory).second) return std::vector<TiffPage>();
    const std::uint64_t entries = file.number(directory, file.countBytes());
    if (!file.ok() || entries > kMostEntries) return std::vector<TiffPage>();
    TiffPage page;
    page.directory = number;
    std::uint64_t subfile = 0;
    const std::uint64_t first = directory + static_cast<unsigned>(file.countBytes());
    const auto length = static_cast<unsigned>(file.entryBytes());
    for (std::uint64_t i = 0; i < entries; ++i) readTag(file, first + i * length, page, subfile);
    if (!file.ok()) return std::vector<TiffPage>();
    if ((subfile & (kReduced | kMask)) == 0) pages.push_back(page);
    directory = file.number(first + entries * length, file.offsetBytes());
  }
  return file.ok() ? pages : std::vector<TiffPage>();
}

}  // namespace microinjection
