#include "vision/layers/polar_body.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace microinjection {
namespace {

constexpr double kSmallestBody = 0.08, kLargestBody = 0.165;  // of the zona's inner radius, a polar body's radius
constexpr int kDirections = 180, kPoints = 24;
constexpr int kClimbRounds = 4;
constexpr double kTurn = 0.012;                   // rad
constexpr double kRadiusStep = 2, kRoomStep = 3;  // px
constexpr double kDerivativeBlur = 1.2;           // px, of the grey values' derivative
constexpr double kFullEdge = 4;                   // of the median derivative between ooplasm and zona: a full edge
constexpr double kRoom = 6;                       // px inside of the zona, where a polar body may end
constexpr double kOtherBody = 0.5;                // rad, of another polar body
constexpr double kLeastCircleScore = 0.45, kSureCircleScore = 0.75;
constexpr double kSureLead = 0.32, kSureLeadOfOtherModes = 0.35;  // over another direction
constexpr double kShade = M_PI / 2;                               // makes the score of a fully shaded border 1
constexpr double kRefiningBand = 4;                               // px, of the points that refine the circle
constexpr double kFollowed = 0.25;                                // rad, that it may turn from frame to frame
constexpr double kSureDirection = 0.02;                           // rad

struct Circle {
  double direction = 0, away = 0, radius = 0, score = -1;
};

/// Derivatives of the grey values in a part of the frame.
class Gradient {
 public:
  Gradient(const Frame& frame, const cv::Rect& region) : origin_(region.tl()) {
    cv::Mat smooth;
    cv::GaussianBlur(frame.grey()(region), smooth, cv::Size(5, 5), kDerivativeBlur);
    cv::Sobel(smooth, x_, CV_32F, 1, 0, 1, 0.5);
    cv::Sobel(smooth, y_, CV_32F, 0, 1, 1, 0.5);
  }
  bool contains(const cv::Point2d& point) const {
    const cv::Point2d p = point - origin_;
    return p.x >= 1 && p.y >= 1 && p.x < x_.cols - 2 && p.y < x_.rows - 2;
  }
  /// Decrease of the grey value along a unit vector (per px).
  double fall(const cv::Point2d& point, const cv::Point2d& along) const {
    const int x = static_cast<int>(std::lround(point.x - origin_.x)),
              y = static_cast<int>(std::lround(point.y - origin_.y));
    return -x_.at<float>(y, x) * along.x - y_.at<float>(y, x) * along.y;
  }

 private:
  cv::Point2d origin_;
  cv::Mat x_, y_;
};

class Search {
 public:
  Search(const Frame& frame, const CellLayers& layers, ContrastMode mode)
      : layers_(layers),
        shaded_(mode == ContrastMode::kDic),
        haloed_(mode == ContrastMode::kPhase),
        lead_(shaded_ || mode == ContrastMode::kPhase ? kSureLeadOfOtherModes : kSureLead),
        centre_(layers.zona_outer.ellipse.centre) {
    const Ellipse& outer = layers.zona_outer.ellipse;
    const bool known = layers.zona_inner.finding.isFound();
    limit_ = known ? layers.zona_inner.ellipse : scaled(outer, 0.99);
    const double inner = 0.5 * limit_.meanDiameter(), ooplasm = 0.5 * layers.ooplasm.ellipse.meanDiameter();
    room_ = known ? kRoom : std::max(kRoom, inner - ooplasm - 2);
    smallest_ = std::max(5.0, kSmallestBody * ooplasm);
    largest_ = kLargestBody * inner;
    const auto reach = static_cast<int>(outer.semi_axes[0]) + 4;
    const cv::Rect box(static_cast<int>(centre_.x) - reach, static_cast<int>(centre_.y) - reach, 2 * reach, 2 * reach);
    region_ = box & cv::Rect(0, 0, frame.grey().cols, frame.grey().rows);
  }

  PolarBody run(const Frame& frame, double towards, double within) {
    PolarBody body;
    body.finding = Finding::notFound("no polar body is seen between ooplasm and zona; it may lie above or below");
    if (region_.width < 20 || region_.height < 20) return body;
    const Gradient gradient(frame, region_);
    setScale(gradient);
    std::vector<Circle> best;
    for (int i = 0; i < kDirections; ++i) {
      const double direction = 2 * M_PI * i / kDirections;
      if (std::abs(std::remainder(direction - towards, 2 * M_PI)) > within) continue;
      best.push_back(bestAt(gradient, direction));
    }
    const auto more = [](const Circle& a, const Circle& b) { return a.score < b.score; };
    if (best.empty()) return body;
    const Circle first = climb(gradient, *std::max_element(best.begin(), best.end(), more));
    double second = 0;
    for (const Circle& other : best) {
      if (std::abs(std::remainder(other.direction - first.direction, 2 * M_PI)) > kOtherBody)
        second = std::max(second, other.score);
    }
    if (first.score < kLeastCircleScore) return body;
    const EllipseFit fit = refined(gradient, first);
    if (!fit.valid) return body;
    const cv::Point2d away = fit.ellipse.centre - centre_;
    body.outline = fit.ellipse;
    body.angle = std::atan2(away.y, away.x);
    const Eigen::Vector2d across(-std::sin(body.angle), std::cos(body.angle));
    body.deviation = std::sqrt(across.dot(fit.covariance.topLeftCorner<2, 2>() * across)) / cv::norm(away);
    const bool sure = first.score > kSureCircleScore && first.score - second > lead_ && body.deviation < kSureDirection;
    const bool zona = layers_.zona_inner.finding.isFound() || layers_.ooplasm.finding.isFound();
    // In phase contrast the halo of a border looks like that of a small circle.
    body.finding = sure && zona && !haloed_ ? Finding::found()
                                            : Finding::uncertain("the polar body's border is faint or one of several");
    return body;
  }

 private:
  cv::Point2d place(const Circle& circle) const {
    return centre_ + circle.away * cv::Point2d(std::cos(circle.direction), std::sin(circle.direction));
  }
  double edge(double fall) const { return std::clamp((shaded_ ? std::abs(fall) : fall) / scale_, -0.3, 1.0); }

  /// The usual derivative in the ring where a polar body may be.
  void setScale(const Gradient& gradient) {
    std::vector<double> sizes;
    for (int i = 0; i < kDirections; ++i) {
      const double direction = 2 * M_PI * i / kDirections;
      const cv::Point2d along(std::cos(direction), std::sin(direction));
      for (double inside = kRoom; inside < kRoom + 2 * largest_; inside += 3) {
        const cv::Point2d point = centre_ + (limit_.reach(centre_, direction) - inside) * along;
        if (gradient.contains(point)) sizes.push_back(std::abs(gradient.fall(point, along)));
      }
    }
    if (sizes.empty()) return;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
    scale_ = std::max(kFullEdge * sizes[sizes.size() / 2], 1e-6);
  }

  Circle bestAt(const Gradient& gradient, double direction) const {
    const double limit = limit_.reach(centre_, direction);
    Circle best;
    for (double radius = smallest_; radius <= largest_; radius += kRadiusStep) {
      for (double room = -2; room <= room_; room += kRoomStep) {
        Circle circle{direction, limit - room - radius, radius, 0};
        circle.score = score(gradient, circle);
        if (circle.score > best.score) best = circle;
      }
    }
    return best;
  }

  /// The best circle near a coarse one.
  Circle climb(const Gradient& gradient, Circle circle) const {
    for (int round = 0; round < kClimbRounds; ++round) {
      const Circle before = circle;
      for (const double turn : {-kTurn, 0.0, kTurn}) {
        for (const double away : {-1.0, 0.0, 1.0}) {
          for (const double radius : {-1.0, 0.0, 1.0}) {
            Circle next = before;
            next.direction += turn;
            next.away += away;
            next.radius += radius;
            next.score = score(gradient, next);
            if (next.score > circle.score) circle = next;
          }
        }
      }
      if (circle.score <= before.score) break;
    }
    return circle;
  }

  /// Mean of the border's edges; in DIC the amplitude of their change with the direction.
  double score(const Gradient& gradient, const Circle& circle) const {
    static const std::vector<cv::Point2d> directions = [] {
      std::vector<cv::Point2d> all;
      for (int i = 0; i < kPoints; ++i)
        all.emplace_back(std::cos(2 * M_PI * i / kPoints), std::sin(2 * M_PI * i / kPoints));
      return all;
    }();
    const cv::Point2d centre = place(circle);
    double sum = 0;
    cv::Point2d shade(0, 0);
    int seen = 0;
    for (const cv::Point2d& along : directions) {
      const cv::Point2d point = centre + circle.radius * along;
      if (!gradient.contains(point)) continue;
      const double fall = gradient.fall(point, along) / scale_;
      sum += std::clamp(fall, -0.3, 1.0);
      shade += std::clamp(fall, -1.0, 1.0) * along;
      ++seen;
    }
    if (seen <= kPoints / 2) return 0;
    return (shaded_ ? kShade * cv::norm(shade) : sum) / seen;
  }

  EllipseFit refined(const Gradient& gradient, const Circle& circle) const {
    const cv::Point2d centre = place(circle);
    std::vector<cv::Point2d> points;
    for (int i = 0; i < 2 * kPoints; ++i) {
      const double angle = M_PI * i / kPoints;
      const cv::Point2d along(std::cos(angle), std::sin(angle));
      double best = 0, at = 0;
      for (double change = -kRefiningBand; change <= kRefiningBand; change += 0.5) {
        const cv::Point2d point = centre + (circle.radius + change) * along;
        const double strength = gradient.contains(point) ? edge(gradient.fall(point, along)) : 0;
        if (strength > best) {
          best = strength;
          at = change;
        }
      }
      if (best > kLeastCircleScore) points.push_back(centre + (circle.radius + at) * along);
    }
    return fitEllipse(points, {centre, {circle.radius, circle.radius}, 0}, 1.0, true);
  }

  const CellLayers& layers_;
  bool shaded_, haloed_;
  double lead_;
  cv::Point2d centre_;
  Ellipse limit_;
  double room_, smallest_, largest_, scale_ = 1;
  cv::Rect region_;
};

PolarBody searchBody(const Frame& frame, const CellLayers& layers, ContrastMode mode, double towards, double within) {
  if (!layers.zona_outer.finding.hasValues()) {
    PolarBody none;
    none.finding = Finding::notFound("a polar body is searched inside of a zona only");
    return none;
  }
  return Search(frame, layers, mode).run(frame, towards, within);
}

}  // namespace

PolarBody findPolarBody(const Frame& frame, const CellLayers& layers, ContrastMode mode) {
  return searchBody(frame, layers, mode, 0, 4);
}

PolarBody followPolarBody(const Frame& frame, const CellLayers& layers, ContrastMode mode, const PolarBody& previous) {
  if (!previous.finding.isFound()) return previous;
  return searchBody(frame, layers, mode, previous.angle, kFollowed);
}

}  // namespace microinjection
