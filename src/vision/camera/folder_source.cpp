#include "vision/camera/folder_source.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "base/errors.h"
#include "vision/camera/natural_order.h"

namespace microinjection {

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
