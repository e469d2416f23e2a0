#pragma once

#include <deque>
#include <optional>
#include <vector>

namespace microinjection {

/// A point of a plot.
struct PlotPoint {
  double x = 0, y = 0;
};
using PlotLine = std::vector<PlotPoint>;

/// What the console plots: the force of the last seconds against time, that of the present contact
/// against depth, and the contacts before.
///
/// Forces in uN along the pipette, depths in um, times in s. An invalid force has no point; a line
/// joins the points before and after it.
class ForceHistory {
 public:
  static constexpr double kWindow = 20;             ///< s, shown against time
  static constexpr std::size_t kPastContacts = 5;   ///< shown in grey
  static constexpr std::size_t kMostPoints = 4000;  ///< of a line; then every second one is left out

  struct Sample {
    double time = 0;                  ///< s, of a clock that does not jump
    std::optional<double> depth;      ///< m past the contact; empty: no contact
    std::optional<double> predicted;  ///< N
    std::optional<double> measured;   ///< N
  };
  void add(const Sample& sample);

  /// Against time from the newest sample, -kWindow to 0.
  PlotLine predictedOverTime() const;
  PlotLine measuredOverTime() const;
  /// Against depth, of the present contact, or of the last one until the next begins.
  const PlotLine& predictedOverDepth() const { return predicted_; }
  const PlotLine& measuredOverDepth() const { return measured_; }
  /// Of each contact before, the oldest first: the measured force, or the predicted one without a
  /// sensor.
  const std::deque<PlotLine>& past() const { return past_; }
  /// Changes with past().
  unsigned contacts() const { return contacts_; }

 private:
  PlotLine overTime(std::optional<double> Sample::*force) const;
  void beginContact();

  std::deque<Sample> samples_;
  PlotLine predicted_, measured_;
  std::deque<PlotLine> past_;
  bool in_contact_ = false;
  unsigned contacts_ = 0;
};

}  // namespace microinjection
