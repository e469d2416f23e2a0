#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "cell/estimation/puncture_prediction.h"

namespace microinjection {

/// Where an indentation begins and ends, how deep it is, whether the cell has failed in it, and what was
/// expected of that. One object serves one indentation after the other.
class IndentationCourse {
 public:
  struct Cell {
    double surface = 0;  ///< m, distance of the surface from the cell's centre
    double clear = 0;    ///< m, distance at which the needle is clear of the cell
  };
  enum class Event { kNone, kEnded, kPunctured };

  /// `tip`: m, relative to the cell's centre. `punctures`: counted by the controller; none: not known.
  Event follow(const Eigen::Vector3d& tip, const Cell& cell, std::optional<unsigned> punctures);
  /// The fit's deepest contact (m), with the needle where it was lowest.
  void learn(double depth);
  /// `force`: N, along the pipette.
  void addForce(double force);
  /// Keeps what is expected at the present depth.
  void expect(const PuncturePrediction& prediction);

  bool touched() const { return touched_; }
  bool punctured() const { return punctured_; }  ///< in this indentation: it is over for the estimate
  bool clear() const { return clear_; }          ///< the needle has been clear of the cell before
  double peak() const { return peak_; }          ///< N, largest force
  double depth() const { return touched_ ? surface_ - lowest_ : 0; }  ///< m, deepest, until the puncture
  double sideways(const Eigen::Vector3d& tip) const;                  ///< m, of the tip since it touched
  /// What was expected when the needle was at half of the present depth.
  std::optional<PuncturePrediction> expectedAtHalf() const;

 private:
  bool touched_ = false, punctured_ = false, clear_ = false;
  unsigned punctures_before_ = 0;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, of the tip at first contact
  double surface_ = 0;                               ///< m, height of the tip at first contact, as far as it is known
  double lowest_ = 0;                                ///< m, of the tip
  double peak_ = 0;
  std::vector<std::pair<double, PuncturePrediction>> expected_;  ///< depths (m) ascend
};

}  // namespace microinjection
