#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/tip_focus.h"

namespace microinjection {

struct FocusSearchConfig {
  double step = 1e-6;        ///< m, between planes
  int planes = 21;           ///< about the plane at the start
  double reach = 60e-6;      ///< m, farthest plane from the start; less take_up below it
  double take_up = 3e-6;     ///< m, by which the focus goes below a plane, so that it comes from below
  int images = 6;            ///< in each plane
  double settle_time = 0.1;  ///< s, at rest before an image counts
  double image_time = 3;     ///< s, in which the images of a plane must come
  double move_time = 10;     ///< s, in which the focus must arrive
  TipFocusConfig focus;

  /// Reads the keys above and the section `curve`.
  static FocusSearchConfig read(ConfigReader& reader);
};

/// Moves the focus over planes and finds the one in which the tip is the sharpest (findFocus). Where
/// the peak is at an end of the planes, it adds planes there, up to the reach. At the end it moves to
/// the best plane.
///
/// An image counts when it was exposed at rest, settle_time after the focus has arrived; a plane's
/// sharpness is the mean of its images. The search fails when the focus does not arrive or leaves a
/// plane by itself, when images do not come, and when the curve has no clear peak.
class FocusSearch {
 public:
  struct Reading {
    double stamp = 0;      ///< s, exposure of the image
    double sharpness = 0;  ///< any unit
  };
  /// What a step knows. Times are of one clock, s.
  struct Input {
    double now = 0;
    std::optional<double> position;  ///< m, of the focus; none: not known now
    std::optional<Reading> reading;  ///< of the newest image; none: that one is not usable
    std::string image_problem;       ///< why it is not
  };

  /// `start`: m, position of the focus. `origin`: m, from which the reach counts; that of an earlier
  /// search of the same tip, if there was one.
  FocusSearch(const FocusSearchConfig& config, double start) : FocusSearch(config, start, start) {}
  FocusSearch(const FocusSearchConfig& config, double start, double origin);

  /// Returns a position (m) of the focus when a move is to be commanded, once each.
  std::optional<double> step(const Input& input);

  bool done() const { return phase_ == Phase::kDone; }
  const std::string& failure() const { return failure_; }  ///< empty: none
  /// After a failure: the sharpest plane (m), if the planes differ and only no bell fits them. The tip's
  /// place was seen out of focus; a search about that plane, with the place seen there, may succeed.
  std::optional<double> sharpest() const;
  const FocusReport& report() const { return report_; }  ///< of the last fit
  std::size_t plane() const { return samples_.size(); }  ///< planes that are done
  std::size_t planes() const;                            ///< and those that are planned with them

 private:
  struct Target {
    double height = 0;     ///< m
    bool observe = false;  ///< else only passed
  };
  enum class Phase { kCommand, kMove, kObserve, kDone };

  void addPlanes(double low, double high);
  void observe(const Input& input);
  void next(const Input& input);
  void evaluate();

  FocusSearchConfig config_;
  double origin_;
  double lowest_ = 0, highest_ = 0;  ///< m, of the planes
  std::deque<Target> targets_;       ///< the first one is under way
  bool returning_ = false;           ///< the last target is the best plane
  Phase phase_ = Phase::kCommand;
  double since_ = 0;               ///< s, begin of the phase
  std::vector<Reading> readings_;  ///< of this plane
  std::vector<FocusSample> samples_;
  FocusReport report_;
  std::string failure_;
};

}  // namespace microinjection
