#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace microinjection {

/// Which image to show with the newest finding: the one that it was found in. A finding comes after
/// its image by the time of the detection; drawn on the newest image it would trail behind a needle
/// that moves. Without findings the newest image is shown.
///
/// `Image`: cheap to copy. Stamps: s, of the images. `now`: s, of a clock that does not jump.
template <typename Image>
class ImagePairing {
 public:
  static constexpr double kFresh = 0.5;       ///< s, after which a finding is not shown
  static constexpr std::size_t kImages = 16;  ///< that are kept: half a second at 30 Hz

  void addImage(double stamp, Image image, double now) {
    if (!images_.empty() && stamp < images_.back().stamp) images_.clear();  // another source
    images_.push_back({stamp, std::move(image)});
    if (images_.size() > kImages) images_.pop_front();
    image_at_ = now;
  }
  void addFinding(double stamp, double now) {
    finding_ = stamp;
    finding_at_ = now;
  }

  bool hasFinding(double now) const { return finding_ && now - finding_at_ < kFresh; }
  /// s since the newest image came; infinite before the first.
  double age(double now) const { return images_.empty() ? std::numeric_limits<double>::infinity() : now - image_at_; }
  std::optional<Image> shown(double now) const {
    if (images_.empty()) return std::nullopt;
    if (!hasFinding(now)) return images_.back().image;
    const Stamped* nearest = &images_.front();
    for (const Stamped& each : images_) {
      if (std::abs(each.stamp - *finding_) < std::abs(nearest->stamp - *finding_)) nearest = &each;
    }
    return nearest->image;
  }

 private:
  struct Stamped {
    double stamp = 0;
    Image image;
  };
  std::deque<Stamped> images_;
  double image_at_ = 0, finding_at_ = 0;  ///< s
  std::optional<double> finding_;         ///< stamp of the newest
};

}  // namespace microinjection
