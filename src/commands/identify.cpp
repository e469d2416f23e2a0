// Fits a recorded force to models of a cell; see --help.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "base/standard_output.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identified_scene.h"
#include "commands/identify_arguments.h"

namespace microinjection {
namespace {

constexpr int kFits = 0, kBadUsage = 2, kFailed = 3, kInconsistent = 4;

/// Geometry of the scene, with what the options say.
FormulaGeometry geometryOf(const std::optional<Scene>& scene, const FormulaGeometry& given) {
  FormulaGeometry result = scene ? FormulaGeometry::of(*scene) : FormulaGeometry();
  if (given.tip_radius > 0) result.tip_radius = given.tip_radius;
  result.half_angle = given.half_angle;
  if (given.poisson_ratio > -1) result.poisson_ratio = given.poisson_ratio;
  return result;
}

std::shared_ptr<ElasticLaw> makeLaw(const std::string& model, const std::optional<Scene>& scene,
                                    const IdentifyArguments& arguments) {
  if (model != "family") return makeFormulaLaw(model, geometryOf(scene, arguments.geometry));
  if (!scene) throw ConfigError("--model family: needs --scene");
  return std::make_shared<FamilyLaw>(findFamily(arguments.families, *scene), *scene, arguments.free);
}

void print(const std::string& model, const Identification& found) {
  std::printf("%s: %s\n", model.c_str(), found.model.c_str());
  for (const Estimate& estimate : found.estimates) {
    std::printf("  %-18s %12.5g %-5s 95 %% interval [%.5g, %.5g]%s\n", estimate.name.c_str(), estimate.value,
                estimate.unit.c_str(), estimate.low, estimate.high, estimate.bounded ? "" : ", open on one side");
  }
  std::printf("  depth %.4g um, force there %.4g nN, noise %.3g nN, %.0f independent samples\n", 1e6 * found.depth,
              1e9 * found.size, 1e9 * found.noise, found.independent);
  std::printf("  what the model cannot follow: %.3g nN, %.2g %% of the force: %s\n", 1e9 * found.misfit,
              100 * found.misfit / found.size, found.consistent() ? "consistent" : "INCONSISTENT");
  for (const std::string& warning : found.warnings) std::printf("  note: %s\n", warning.c_str());
}

std::string residualTable(const ForceCurve& curve, const Identification& found) {
  std::string table = "time_s,depth_m,force_N,fitted_N,residual_N\n";
  const double contact = found.find("contact")->value;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double residual = found.residuals[static_cast<Eigen::Index>(i)];
    char row[160];
    std::snprintf(row, sizeof(row), "%.9g,%.9g,%.9g,%.9g,%.9g\n", curve.time[i], curve.position[i] - contact,
                  curve.force[i], curve.force[i] - residual, residual);
    table += row;
  }
  return table;
}

int run(int argc, char** argv) {
  const std::optional<IdentifyArguments> parsed = parseIdentifyArguments(argc, argv);
  if (!parsed) {
    flushStandardOutput();  // the help
    return kFits;
  }
  const IdentifyArguments& arguments = *parsed;
  std::optional<Scene> scene;
  if (!arguments.scene.empty()) scene = loadScene(arguments.scene);
  std::vector<std::shared_ptr<ElasticLaw>> laws;
  for (const std::string& model : arguments.models) laws.push_back(makeLaw(model, scene, arguments));
  const ForceCurve curve = identifiedCurve(readForceCurve(arguments.record, arguments.curve));
  for (const std::string& note : curve.notes) std::printf("%s: %s\n", arguments.record.c_str(), note.c_str());

  std::vector<Identification> fits;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    try {
      fits.push_back(identify(curve, laws[i], arguments.identification));
      names.push_back(arguments.models[i]);
      print(names.back(), fits.back());
    } catch (const ConfigError& error) {
      std::cerr << "identify: " << arguments.record << ": " << arguments.models[i] << ": " << error.what() << '\n';
      if (i == 0) return kFailed;
    }
  }
  if (fits.size() > 1) {
    const std::vector<double> criteria = informationCriteria(fits);
    const auto best = std::min_element(criteria.begin(), criteria.end()) - criteria.begin();
    std::printf("the information criterion prefers: %s\n", names[static_cast<std::size_t>(best)].c_str());
  }
  const Identification& first = fits.front();
  flushStandardOutput();
  if (!arguments.residuals.empty()) writeFileAtomically(arguments.residuals, residualTable(curve, first));
  if (!first.consistent()) {
    std::cerr << "identify: " << arguments.models[0] << " does not follow the record: no scene is written\n";
    return kInconsistent;
  }
  if (!arguments.out.empty()) {
    writeFileAtomically(arguments.out, identifiedScene(arguments.scene, arguments.record, first));
  }
  return kFits;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& exception) {
    std::cerr << "identify: " << exception.what() << '\n';
    return microinjection::kBadUsage;
  }
}
