#include "vision/camera/folder_source.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "base/errors.h"

namespace microinjection {
namespace {

bool digitAt(const std::string& text, std::size_t i) {
  return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i]));
}

/// Takes the run of digits at `i`, without leading zeros, and moves `i` behind it.
std::string takeNumber(const std::string& text, std::size_t& i) {
  while (text[i] == '0' && digitAt(text, i + 1)) ++i;
  const std::size_t begin = i;
  while (digitAt(text, i)) ++i;
  return text.substr(begin, i - begin);
}

/// Whether `a` comes before `b` when each run of digits counts as one whole number: stack0.2 before
/// stack0.10. A total order: names that differ only in leading zeros are ordered as text.
bool naturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digitAt(a, i) && digitAt(b, j)) {
      const std::string left = takeNumber(a, i), right = takeNumber(b, j);
      // Of two numbers without leading zeros the longer one is larger, whatever their length.
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

}  // namespace

namespace fs = std::filesystem;

FolderSource::FolderSource(const std::string& folder, double rate, bool loop) : period_(1 / rate), loop_(loop) {
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  if (error) throw ConfigError(folder + ": is no folder that can be read: " + error.message());
  for (; entry != fs::directory_iterator(); entry.increment(error)) {
    if (error) throw ConfigError(folder + ": cannot be listed: " + error.message());
    if (hasImageName(entry->path().string()) && !entry->is_directory(error)) paths_.push_back(entry->path().string());
  }
  std::sort(paths_.begin(), paths_.end(), naturalLess);
  if (paths_.empty()) report(folder + ": has no images");
}

std::optional<CameraFrame> FolderSource::next() {
  // One loop without a readable image ends the search.
  for (std::size_t tried = 0; tried < paths_.size();) {
    if (!file_) {
      if (position_ == paths_.size()) {
        if (!loop_) return std::nullopt;
        position_ = 0;
      }
      file_.emplace(paths_[position_++]);
      page_ = 0;
    }
    const std::string& path = paths_[position_ - 1];
    const double stamp = static_cast<double>(count_++) * period_;
    LoadedImage loaded = file_->load(page_);
    const std::string name = file_->nameOf(page_);
    if (++page_ == file_->pages()) {
      file_.reset();
      ++tried;
    }
    if (loaded.refusal.empty()) return CameraFrame{loaded.image, stamp, name};
    report((fs::path(path).parent_path() / name).string() + ": " + loaded.refusal);
  }
  return std::nullopt;
}

}  // namespace microinjection
