#include "benchmark/paper/tensegrity_curves.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "cell/tensegrity/tensegrity_loading.h"

namespace microinjection {
namespace {

/// The table, written after each curve: what comes too late leaves the others.
class Curves {
 public:
  explicit Curves(const TensegrityStudy& study) : study_(study) {}

  /// Force of one curve; stops where there is no equilibrium.
  void add(const std::string& label, const TensegrityConfig& config, Where where, double deepest, int points) {
    const auto structure = std::make_shared<const TensegrityStructure>(config);
    TensegrityLoading loading(structure, following(*structure, where, study_.scene.needle.tip.radius));
    for (int i = 0; i <= points; ++i) {
      const LoadPath::Result result = loading.advance({0, 0, -deepest * i / points});
      if (!result.converged) {
        std::cerr << label << ": no equilibrium beyond " << -1e6 * loading.displacement().z() << " um\n";
        break;
      }
      int slack = 0;
      for (int k = 0; k < loading.cables().elementCount(); ++k)
        slack += loading.cables().tension(k, loading.state()) == 0;
      double compression = 0;
      for (int strut = 0; strut < 6; ++strut) {
        compression = std::max(compression, -structure->strutForce(strut, loading.state()));
      }
      const Eigen::Vector3d force = loading.force();
      rows_ += line("%s,%s,%.6g,%d,%s,%.6g,%.6g,%.6g,%.6g,%d,%.6g,%d\n", label.c_str(), name(where),
                    config.actin.prestrain, config.actin.filaments.count, config.microtubules.model.c_str(),
                    -loading.displacement().z(), force.x(), force.y(), force.z(), slack, compression, loading.snaps());
    }
    std::cout << label << ", " << name(where) << " done" << std::endl;
    study_.write(
        "curves",
        "curve,where,prestrain,count,model,depth_m,force_x_N,force_y_N,force_z_N,slack,compression_N,snaps\n" + rows_);
  }

 private:
  const TensegrityStudy& study_;
  std::string rows_;
};

void figure12(const TensegrityStudy& study, Curves& curves) {
  for (const double prestrain : {0.0, 0.05, 0.1, 0.2}) {
    TensegrityConfig config = study.config();
    config.actin.prestrain = config.intermediate.prestrain = prestrain;
    for (const Where where : {Where::kEnd, Where::kBetween}) curves.add("figure_12", config, where, 10e-6, 10);
  }
}

void figure13(const TensegrityStudy& study, Curves& curves) {
  for (const double share : {1.0, 0.3, 0.1}) {
    TensegrityConfig config = study.config();
    config.actin.filaments.count = config.intermediate.filaments.count = static_cast<int>(100 * share);
    config.microtubules.filaments.count = static_cast<int>(config.microtubules.filaments.count * std::sqrt(share));
    curves.add("figure_13", config, Where::kEnd, 45e-6, 18);
    if (share == 1) curves.add("figure_13", config, Where::kBetween, 45e-6, 18);
  }
  for (const std::string& model : {std::string("linear"), std::string("st_venant_kirchhoff")}) {
    TensegrityConfig config = study.config();
    config.microtubules.model = model;
    curves.add("models", config, Where::kEnd, 10e-6, 10);
  }
}

}  // namespace

void writeCurves(const TensegrityStudy& study) {
  Curves curves(study);
  figure12(study, curves);
  figure13(study, curves);
}

}  // namespace microinjection
