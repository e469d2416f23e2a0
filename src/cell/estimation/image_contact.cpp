#include "cell/estimation/image_contact.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/median.h"

namespace microinjection {
namespace {

constexpr double kBeside = 0.5;            // of the radius, of a tip that does not press from above
constexpr double kErrorOfMedian = 1.2533;  // over that of the mean

}  // namespace

void ImageContactConfig::read(ConfigReader& reader) {
  reader.integer("images", images, Range::closed(1, 1000));
  reader.integer("least_images", least_images, Range::closed(1, 1000));
  reader.number("shared_error", shared_error, Range::positive());
  reader.number("largest_depth", largest_depth, Range::positive());
  if (least_images > images) reader.error("least_images", "must not be above images");
}

ImageContact::ImageContact(const ImageContactConfig& config, double radius)
    : config_(config), radius_(radius), heights_(static_cast<std::size_t>(config.images)) {}

void ImageContact::add(const Eigen::Vector3d& tip, double depth, double deviation) {
  const double beside = std::hypot(tip.x(), tip.y());
  const bool sane = tip.allFinite() && depth != 0 && std::abs(depth) <= config_.largest_depth && deviation > 0 &&
                    std::isfinite(deviation) && beside <= kBeside * radius_;
  if (!sane) return;
  const double surface = std::sqrt(radius_ * radius_ - beside * beside);
  heights_.push_back({tip.z() + depth - surface, deviation});
}

std::optional<ImageContact::Height> ImageContact::height() const {
  if (heights_.size() < static_cast<std::size_t>(config_.least_images)) return std::nullopt;
  std::vector<double> heights, deviations;
  for (const Seen& seen : heights_) {
    heights.push_back(seen.height);
    deviations.push_back(seen.deviation);
  }
  // The images' own deviations, or what they truly scatter: whichever is larger.
  const double height = upperMedian(heights);
  std::vector<double> away;
  for (const double each : heights) away.push_back(std::abs(each - height));
  const double scatter = std::max(upperMedian(deviations), 1.4826 * upperMedian(away));
  const double mean = kErrorOfMedian * scatter / std::sqrt(static_cast<double>(heights.size()));
  return Height{height, std::hypot(mean, config_.shared_error)};
}

}  // namespace microinjection
