#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/estimation/sample_history.h"
#include "cell/material/force_memory.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {

/// The force that a cell's member of a family predicts on the path of a tip.
class ForcePath {
 public:
  ForcePath(const Scene& scene, std::shared_ptr<const SurrogateData> cell)
      : contact_(scene, std::move(cell)), memory_(scene.cell.material().viscoelasticity.prony) {}

  struct Point {
    double force = 0;  ///< N, along the pipette, with its relaxation
    double depth = 0;  ///< m, past the contact point
    bool touches = false;
    bool prepared = true;  ///< false: outside of the surrogate's range, where the force is none to learn from
  };

  /// One point for each sample. `shift`: m, of the cell's surface along +z.
  void predict(const std::vector<SampleHistory::Sample>& samples, double shift, std::vector<Point>& points);

 private:
  SurrogateContact contact_;
  ForceMemory memory_;
};

}  // namespace microinjection
