#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell/estimation/sample_history.h"
#include "cell/identification/rival_test.h"
#include "cell/surrogate/surrogate_data.h"

namespace microinjection {

/// Compares the served cell with its rivals while the needle indents, each time it is another half of a
/// micrometre deeper. Only for elastic cells and a needle near the cell's axis.
class RivalWatch {
 public:
  /// What is known of the surface and of the sensor before.
  struct Config {
    double contact_deviation = 0;  ///< m
    double offset_deviation = 0;   ///< N
    double sensor_floor = 0;       ///< N, of a sample, beside its noise
  };
  /// What is known of the served cell.
  struct Estimate {
    double modulus = 0;  ///< Pa
    double contact = 0;  ///< m, above where the surface is modelled
    double offset = 0;   ///< N
    double depth = 0;    ///< m
  };

  /// `cell`: the scene's member, in SI units. Without rivals there is never a contradiction.
  RivalWatch(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell,
             std::shared_ptr<const std::vector<RivalCell>> rivals, const Config& config);

  /// `noise`: N, of a reading. Returns the rival that followed the readings clearly better at two depths
  /// in a row; empty if none did. Milliseconds at a new depth, else nothing.
  const std::string& follow(const std::vector<SampleHistory::Sample>& samples, double noise, const Estimate& estimate);
  /// Another indentation.
  void reset();

 private:
  bool compare(const std::vector<SampleHistory::Sample>& samples, double noise, const Estimate& estimate);

  double radius_;                           ///< m
  std::optional<EstimatedCell> estimated_;  ///< empty when there is nothing to compare
  std::shared_ptr<const std::vector<RivalCell>> rivals_;
  Config config_;
  double compared_ = 0;  ///< m, depth
  int contradictions_ = 0;
  std::string better_, last_;
};

}  // namespace microinjection
