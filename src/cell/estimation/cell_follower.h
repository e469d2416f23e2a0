#pragma once

#include <optional>

#include "base/config_reader.h"

namespace microinjection {

/// How often and how far the served cell follows the one that was found.
struct CellFollowerConfig {
  double period = 0.03;          ///< s, from one change to the next
  double least_change = 0.005;   ///< of the modulus: a smaller one is not worth it
  double largest_change = 0.25;  ///< of the modulus's logarithm at once, so that the hand feels no step
  double least_height = 20e-9;   ///< m, as least_change
  double largest_height = 2e-6;  ///< m, from the cell's place in the scene

  void read(ConfigReader& reader);
};

/// What cell_simulator is asked to serve, in small steps from the served cell to the one that was found.
/// Modulus and height change together: each alone would be a cell that no fit has found. The next step
/// waits until the last one is served.
class CellFollower {
 public:
  struct Properties {
    double modulus = 0;  ///< Pa
    double height = 0;   ///< m, above the cell's place in the scene
  };

  CellFollower(const CellFollowerConfig& config, double modulus) : config_(config), served_{modulus, 0} {}

  /// The cell that cell_simulator reports.
  void setServed(const Properties& served) { served_ = served; }
  const Properties& served() const { return served_; }
  /// What is to be asked for at `time` (s), if anything is.
  std::optional<Properties> ask(const Properties& found, double time);
  /// Whether cell_simulator does not serve what it was asked to.
  bool refused() const { return refused_; }

 private:
  bool isServed() const;

  CellFollowerConfig config_;
  Properties served_;
  std::optional<Properties> asked_;
  double asked_at_ = 0;  ///< s
  bool refused_ = false;
};

}  // namespace microinjection
