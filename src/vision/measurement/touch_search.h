#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/setpoint_stream.h"
#include "vision/calibration/touch_by_vision.h"

namespace microinjection {

struct TouchSearchConfig {
  double step = 0.3e-6;            ///< m, along the needle
  double speed = 10e-6;            ///< m/s, of the set-point
  double largest_travel = 40e-6;   ///< m, from the start
  double largest_force = 0.3e-6;   ///< N, above that at the start
  double largest_depth = 4e-6;     ///< m past the outline in the image, in which it must give way
  double largest_offset = 1.5e-6;  ///< m between the touch and the place where the tip meets the outline in the image
  double settle_time = 0.1;        ///< s, at rest before an image counts
  double image_time = 3;           ///< s, in which a fresh image must come
  double move_time = 3;            ///< s, in which the needle must arrive at a step
  TouchByVisionConfig touch = [] {
    TouchByVisionConfig curve;
    curve.exponent = 1.25;  // between a flat tip and a round one
    return curve;
  }();

  /// Reads the keys above and the section `curve`.
  static TouchSearchConfig read(ConfigReader& reader);
};

/// Lowers the needle step by step along its axis and watches the outline of the cell beside it, until
/// findTouch sees that it gives way. A stream of set-points for a controller that follows them.
///
/// An image counts when it was exposed at rest, settle_time after the needle has arrived, and when
/// twenty readings of a known force were taken at this rest. Their mean is the force of the step: one
/// reading may be off by as much as the force of a touch. Each image also has the tip's gap to the undisturbed outline.
/// A needle before or behind the cell crosses the outline too, which then stays where it is: only the displacement
/// shows a touch, and the gap is its second witness. Where an uncertain tip is not where the travel has it, by the gaps
/// of earlier images, the image counts with its displacement only.
///
/// The search fails, and its set-points end, when
/// - the needle does not arrive, leaves its line, or its position or the force is lost;
/// - no fresh image comes, or the force exceeds its limit;
/// - the tip starts at the outline, is largest_depth past it without a touch, or the touch is more
///   than largest_offset from it;
/// - the travel ends without a touch.
class TouchSearch {
 public:
  struct Observation {
    double stamp = 0;         ///< s, exposure of the image
    double displacement = 0;  ///< px, of the outline under the tip, along the needle
    double deviation = 0;     ///< px, standard deviation of it
    double gap = 0;           ///< px along the needle, from the undisturbed outline to the tip; negative: deeper
    bool certain = true;      ///< cell and tip were found for certain
  };
  /// What a step knows. Times are of one clock, s.
  struct Input {
    double now = 0;
    std::optional<Eigen::Vector3d> position;  ///< m, of the needle; none: not known now
    double rested_since = 0;                  ///< s
    std::optional<Observation> observation;   ///< of the newest image; none: it does not show cell and tip
    std::string image_problem;                ///< why not
    std::optional<double> force;              ///< N along the needle; none: not known now
    double force_stamp = 0;                   ///< s, of that reading
  };

  /// `start`: where the needle rests; `direction`: unit vector of the approach; `now`: s. A force that
  /// is known at the start must stay known.
  TouchSearch(const TouchSearchConfig& config, const Eigen::Vector3d& start, const Eigen::Vector3d& direction,
              const Input& input);

  /// The set-point (m); none once it is done or has failed.
  std::optional<Eigen::Vector3d> step(const Input& input);

  bool done() const { return report_.verdict == TouchVerdict::kTouch && failure_.empty(); }
  const std::string& failure() const { return failure_; }     ///< empty: none
  const std::string& waitsFor() const { return waits_for_; }  ///< empty while it moves
  double travel() const { return travel_; }                   ///< m, of the set-point
  double displacement() const { return displacement_; }       ///< px, in the last image used
  double touchTravel() const { return report_.height; }       ///< m, from the start; once done
  double interval() const { return report_.interval.half(); }
  /// m, from the start: where the tip meets the undisturbed outline in the image; none before five images.
  std::optional<double> outlineTravel() const;
  Eigen::Vector3d contact() const { return start_ + report_.height * direction_; }  ///< m; once done
  std::optional<double> force() const { return force_; }  ///< N, the newest reading, above that at the start
  /// N, mean of the rest at the last image, above that of the first rest; none: the force is not known.
  std::optional<double> restingForce() const { return resting_force_; }
  const std::string& text() const { return report_.text; }

 private:
  /// Of a force while the needle rests.
  struct Mean {
    double sum = 0;  ///< N
    int count = 0;
    void add(double value) { sum += value, ++count; }
    double value() const { return sum / count; }
  };

  void watch(const Input& input);
  void averageForce(const Input& input, bool arrived);
  double restedSince(const Input& input) const { return std::max(input.rested_since, since_); }
  bool look(const Input& input);
  std::string noStep() const;
  double trustedGap(const Observation& observation) const;
  void take(const Observation& observation, double now);
  void compareWithOutline();
  std::optional<Eigen::Vector2d> gapLine() const;
  void fail(const std::string& text, double value, const std::string& rest);

  TouchSearchConfig config_;
  Eigen::Vector3d start_;
  SetpointStream stream_;
  Eigen::Vector3d direction_;
  std::optional<double> force_at_start_, force_, resting_force_;
  Mean rest_;                     ///< of the force since the needle has arrived at the present step
  double force_stamp_ = 0;        ///< s, of the newest reading in it
  double travel_ = 0, goal_ = 0;  ///< m, of the set-point
  double stepped_, since_;        ///< s, of the last step(), and of the present step of the needle
  double displacement_ = 0;
  std::vector<TouchSample> samples_;
  std::vector<double> gaps_;  ///< px, of the samples; NaN: not trusted
  TouchReport report_;
  std::string failure_, waits_for_;
};

}  // namespace microinjection
