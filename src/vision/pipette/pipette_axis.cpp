#include "vision/pipette/pipette_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr int kLongSide = 360;    // px, at most, of the reduced frame
constexpr int kLineAngles = 180;  // of lines, over half a turn
constexpr int kLines = 32;
constexpr double kLineOverNoise = 5;                       // of the gradient's noise
constexpr double kLeastNoise = 1.2e-3;                     // of the range, of a gradient; compression has its own
constexpr double kLeastLength = 18;                        // px in the reduced frame
constexpr double kLeastLengthAtBorder = 7;                 // the same, of a needle that has just come into it
constexpr double kSameDirection = 0.03, kSamePlace = 2.5;  // rad, px in the reduced frame

/// A line of edges: normal (cos a, sin a), a in [0, pi); n . p = offset.
struct Line {
  double angle, offset, weight;
};

double halfTurn(double angle) {
  const double rest = std::fmod(angle, M_PI);
  return rest < 0 ? rest + M_PI : rest;
}

/// Difference of two directions of lines, in [-pi/2, pi/2].
double turn(double a, double b) {
  double d = std::fmod(a - b, M_PI);
  if (d > M_PI / 2) d -= M_PI;
  if (d < -M_PI / 2) d += M_PI;
  return d;
}

struct Accumulator {
  cv::Mat votes;  ///< angles x offsets
  double shift;   ///< of the offsets
};

/// Every thinned edge votes for the lines along it, a faint one nearly as much as a strong one.
class LineVotes {
 public:
  LineVotes(const cv::Size& size, const AxisSearch& search)
      : search_(search), shift_(std::ceil(std::hypot(size.width, size.height)) + 1) {
    votes_ = cv::Mat::zeros(kLineAngles, 2 * static_cast<int>(shift_) + 1, CV_32F);
    for (int row = 0; row < kLineAngles; ++row) {
      const double a = (row + 0.5) * M_PI / kLineAngles;
      cosine_[row] = std::cos(a);
      sine_[row] = std::sin(a);
    }
  }

  /// @param whole  of the reduced frame, of which the image is a part
  void add(const cv::Mat& image, double noise, const cv::Point2d& corner, const cv::Size2d& whole, double scale) {
    cv::Mat smooth, gx, gy, size;
    cv::GaussianBlur(image, smooth, cv::Size(5, 5), 1);
    cv::Sobel(smooth, gx, CV_32F, 1, 0, 3, 0.125);
    cv::Sobel(smooth, gy, CV_32F, 0, 1, 3, 0.125);
    cv::magnitude(gx, gy, size);
    const double least = kLineOverNoise * noise;
    for (int y = 2; y < image.rows - 2; ++y) {
      for (int x = 2; x < image.cols - 2; ++x) {
        const double g = size.at<float>(y, x);
        if (g < least) continue;
        if (search_.region.empty() && !isSearched(cv::Point2d(x, y) + corner, whole, scale)) continue;
        const float nx = gx.at<float>(y, x), ny = gy.at<float>(y, x);
        const int dx = static_cast<int>(std::lround(nx / g)), dy = static_cast<int>(std::lround(ny / g));
        if (size.at<float>(y + dy, x + dx) > g || size.at<float>(y - dy, x - dx) >= g) continue;
        addEdge(x, y, std::atan2(ny, nx), static_cast<float>(std::min(1.0, 0.3 + 0.1 * g / least)));
      }
    }
  }

  const cv::Mat& votes() const { return votes_; }
  double shift() const { return shift_; }

 private:
  bool isSearched(const cv::Point2d& place, const cv::Size2d& whole, double scale) const {
    const cv::Point2d u(std::cos(search_.direction), std::sin(search_.direction));
    if ((place - 0.5 * cv::Point2d(whole.width, whole.height)).dot(u) < 0) return false;
    const cv::Point2d beyond = place + search_.from_border / scale * u;
    return search_.from_border == 0 || beyond.x < 0 || beyond.y < 0 || beyond.x >= whole.width ||
           beyond.y >= whole.height;
  }

  void addEdge(int x, int y, double normal, float weight) {
    const double angle = halfTurn(normal);
    if (std::abs(turn(angle - M_PI / 2, search_.direction)) > search_.tolerance + search_.steepest_taper) return;
    const int middle = static_cast<int>(angle / M_PI * kLineAngles);
    for (int k = -2; k <= 2; ++k) {
      const int row = (middle + k + kLineAngles) % kLineAngles;
      const int column = static_cast<int>(std::lround(x * cosine_[row] + y * sine_[row] + shift_));
      votes_.at<float>(row, column) += weight;
    }
  }

  AxisSearch search_;
  cv::Mat votes_;  ///< angles x offsets
  double shift_;   ///< of the offsets
  std::array<double, kLineAngles> cosine_, sine_;
};

std::vector<Line> linesOf(const LineVotes& accumulator, double least_length) {
  cv::Mat votes;
  cv::GaussianBlur(accumulator.votes(), votes, cv::Size(3, 3), 0.8);
  cv::Mat highest;
  cv::dilate(votes, highest, cv::Mat::ones(5, 5, CV_8U));
  std::vector<Line> lines;
  for (int row = 0; row < votes.rows; ++row) {
    for (int column = 0; column < votes.cols; ++column) {
      const float value = votes.at<float>(row, column);
      if (value < 0.3 * least_length || value < highest.at<float>(row, column)) continue;
      lines.push_back({(row + 0.5) * M_PI / kLineAngles, column - accumulator.shift(), value});
    }
  }
  std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.weight > b.weight; });
  if (lines.size() > kLines) lines.resize(kLines);
  return lines;
}

/// Place of a line beside `origin` along the normal `angle`.
double placeAlong(const Line& line, const cv::Point2d& origin, double angle) {
  const double rest = line.offset - origin.x * std::cos(line.angle) - origin.y * std::sin(line.angle);
  const double slant = std::cos(line.angle - angle);
  return rest / (std::abs(slant) < 1e-3 ? 1e-3 : slant);
}

/// The axis of symmetry of two lines. Its offset is measured from `origin`.
PipetteAxis between(const Line& a, const Line& b, const cv::Point2d& origin) {
  const double difference = turn(a.angle, b.angle), normal = b.angle + 0.5 * difference;
  const double pa = placeAlong(a, origin, normal), pb = placeAlong(b, origin, normal), middle = 0.5 * (pa + pb);
  PipetteAxis axis;
  axis.direction = normal - M_PI / 2;
  axis.point = origin + cv::Point2d(middle * std::cos(normal), middle * std::sin(normal));
  axis.half_width = 0.5 * std::abs(pa - pb);
  // Along the direction (sin normal, -cos normal) a line's place moves by the tangent of its slant.
  axis.taper = (pa > pb ? 1 : -1) * std::tan(0.5 * difference);
  axis.weight = std::min(a.weight, b.weight);
  return axis;
}

bool allowed(const PipetteAxis& axis, double difference, const AxisSearch& search, double scale) {
  return std::abs(difference) < 2 * search.steepest_taper && axis.half_width * 2 * scale < search.widest &&
         std::abs(turn(axis.direction, search.direction)) < search.tolerance;
}

double offsetOf(const PipetteAxis& axis, const cv::Point2d& origin) {
  const cv::Point2d d = axis.point - origin;
  return -d.x * std::sin(axis.direction) + d.y * std::cos(axis.direction);
}

/// Axes that several pairs of lines share. The outline of one is that of its widest clear pair.
std::vector<PipetteAxis> shared(const std::vector<PipetteAxis>& pairs, const cv::Point2d& origin, int most) {
  std::vector<PipetteAxis> found;
  std::vector<double> support(pairs.size(), 0);
  const auto same = [&](const PipetteAxis& a, const PipetteAxis& b) {
    const double d = turn(a.direction, b.direction);
    const double sign = std::cos(a.direction - b.direction) < 0 ? -1 : 1;
    return std::abs(d) < kSameDirection && std::abs(offsetOf(a, origin) - sign * offsetOf(b, origin)) < kSamePlace;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const PipetteAxis& other : pairs) support[i] += same(pairs[i], other) ? other.weight : 0;
  }
  std::vector<std::size_t> order(pairs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return support[a] > support[b]; });
  for (const std::size_t i : order) {
    if (static_cast<int>(found.size()) >= most) break;
    if (std::any_of(found.begin(), found.end(), [&](const auto& axis) { return same(axis, pairs[i]); })) continue;
    PipetteAxis axis = pairs[i];
    for (const PipetteAxis& other : pairs) {
      if (same(other, pairs[i]) && other.weight > 0.5 * axis.weight && other.half_width > axis.half_width) axis = other;
    }
    axis.weight = support[i];
    found.push_back(axis);
  }
  return found;
}

}  // namespace

double PipetteAxis::outlineAt(const cv::Point2d& place) const {
  const cv::Point2d d = place - point;
  return std::max(0.0, half_width + taper * (d.x * std::cos(direction) + d.y * std::sin(direction)));
}

cv::Point2d PipetteAxis::entry(const Frame& frame) const {
  const cv::Point2d u(std::cos(direction), std::sin(direction));
  cv::Point2d place = point;
  while (frame.contains(place, 1)) place += u;
  while (!frame.contains(place, 1) && cv::norm(place - point) < 4000) place -= u;
  return place;
}

std::vector<PipetteAxis> findPipetteAxes(const Frame& frame, const AxisSearch& search, int most) {
  const double side = std::max(frame.width(), frame.height());
  const int level = std::clamp(static_cast<int>(std::ceil(std::log2(side / kLongSide))) - search.finer, 0, 4);
  const double scale = std::ldexp(1, level);
  cv::Mat image = frame.level(level);
  cv::Point2d corner(0, 0);
  if (!search.region.empty()) {
    const cv::Rect whole(cv::Point(0, 0), image.size());
    const cv::Rect part(static_cast<int>(search.region.x / scale), static_cast<int>(search.region.y / scale),
                        static_cast<int>(search.region.width / scale), static_cast<int>(search.region.height / scale));
    if ((part & whole).area() < 64) return {};
    image = image(part & whole);
    corner = (part & whole).tl();
  }
  LineVotes votes(image.size(), search);
  votes.add(image, std::max(0.25 * frame.noise(), kLeastNoise) / scale, corner, frame.level(level).size(), scale);
  const std::vector<Line> lines = linesOf(votes, search.from_border > 0 ? kLeastLengthAtBorder : kLeastLength);
  const cv::Point2d origin(0.5 * (image.cols - 1), 0.5 * (image.rows - 1));
  std::vector<PipetteAxis> pairs;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const PipetteAxis axis = between(lines[i], lines[j], origin);
      if (allowed(axis, turn(lines[i].angle, lines[j].angle), search, scale)) pairs.push_back(axis);
    }
  }
  std::vector<PipetteAxis> axes = shared(pairs, origin, most);
  for (PipetteAxis& axis : axes) {
    axis.point = Frame::fromLevel(axis.point + corner, level);
    axis.half_width *= scale;
    if (std::cos(axis.direction - search.direction) < 0) {
      axis.direction += M_PI;
      axis.taper = -axis.taper;
    }
  }
  return axes;
}

}  // namespace microinjection
