// Fits a recorded force to models of a cell; see --help.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/plausible.h"
#include "base/standard_output.h"
#include "base/text_table.h"
#include "cell/identification/combined_modulus.h"
#include "cell/identification/contact_guess.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"
#include "cell/identification/identified_scene.h"
#include "cell/identification/point_identification.h"
#include "cell/identification/tongue_identification.h"
#include "commands/identify_arguments.h"
#include "commands/scene_law.h"
#include "commands/tongue_images.h"

namespace microinjection {
namespace {

/// Rows of the CSV of --csv, below this line.
constexpr char kEstimateColumns[] = "model,quantity,value,low,high,unit,bounded\n";

void printRivals(const RivalComparison& rivals) {
  if (rivals.contradicts()) {
    std::printf("  another cell follows the record clearly better: %s, outermost modulus %.4g Pa\n",
                rivals.best.c_str(), rivals.best_modulus);
  } else if (!rivals.layersAreKnown()) {
    std::printf(
        "  note: cells with other layers, of an outermost modulus from %.4g to %.4g Pa, follow the record as "
        "well: it does not tell them apart\n",
        rivals.modulus_low, rivals.modulus_high);
  }
}

/// Prints what was found by `model` on the standard output.
void printIdentification(const std::string& model, const Identification& found) {
  std::printf("%s: %s\n", model.c_str(), found.model.c_str());
  for (const Estimate& estimate : found.estimates) {
    std::printf("  %-18s %12.5g %-5s 95 %% interval [%.5g, %.5g]%s\n", estimate.name.c_str(), estimate.value,
                estimate.unit.c_str(), estimate.low, estimate.high,
                estimate.bounded() ? "" : (", open " + estimate.open()).c_str());
  }
  if (found.residuals.size() == 0) {
    if (found.depth > 0) std::printf("  depth %.4g um, force there %.4g nN\n", 1e6 * found.depth, 1e9 * found.size);
    for (const std::string& warning : found.warnings) std::printf("  note: %s\n", warning.c_str());
    return;
  }
  std::printf("  depth %.4g um, force there %.4g nN, noise %.3g nN, %.0f independent samples\n", 1e6 * found.depth,
              1e9 * found.size, 1e9 * found.noise, found.independent);
  std::printf("  what the model cannot follow: %.3g nN, %.2g %% of the force: %s\n", 1e9 * found.misfit,
              100 * found.misfit / found.size, found.consistent() ? "consistent" : "INCONSISTENT");
  if (found.rivals) printRivals(*found.rivals);
  for (const std::string& warning : found.warnings) std::printf("  note: %s\n", warning.c_str());
}

std::string estimateRows(const std::string& model, const Identification& found) {
  std::string rows;
  for (const Estimate& estimate : found.estimates) {
    char row[200];
    std::snprintf(row, sizeof(row), "%s,%s,%.9g,%.9g,%.9g,%s,%d\n", model.c_str(), estimate.name.c_str(),
                  estimate.value, estimate.low, estimate.high, estimate.unit.c_str(), estimate.bounded());
    rows += row;
  }
  return rows;
}

/// CSV of --residuals.
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

constexpr int kFits = 0, kInconsistent = 4, kUndetermined = 5;

/// Geometry of the scene, with what the options say.
FormulaGeometry geometryOf(const std::optional<Scene>& scene, const FormulaGeometry& given) {
  FormulaGeometry result = scene ? FormulaGeometry::of(*scene) : FormulaGeometry();
  if (given.tip_radius > 0) result.tip_radius = given.tip_radius;
  result.half_angle = given.half_angle;
  if (given.poisson_ratio > -1) result.poisson_ratio = given.poisson_ratio;
  return result;
}

bool isSolved(const std::string& model) { return model == "solution" || model == "live"; }

/// `deepest`: m, of the record.
std::shared_ptr<ElasticLaw> makeLaw(const std::string& model, const std::optional<Scene>& scene,
                                    const IdentifyArguments& arguments, double deepest) {
  if (model != "family" && !isSolved(model)) return makeFormulaLaw(model, geometryOf(scene, arguments.geometry));
  if (!scene) throw ConfigError("--model " + model + ": needs --scene");
  if (isSolved(model)) return solveSceneLaw(*scene, model == "live", deepest, arguments.free_material);
  return std::make_shared<FamilyLaw>(findFamily(arguments.families, *scene), *scene, arguments.free);
}

/// m, that a solution has to reach: somewhat more than the first estimate of the record's depth.
double depthOf(const ForceCurve& curve) {
  constexpr double kMore = 1.1;
  const ContactGuess guess = guessContact(curve, false);
  const auto [low, high] = std::minmax_element(curve.position.begin(), curve.position.end());
  return guess.touched ? std::min(kMore * guess.depth, *high - *low) : *high - *low;
}

/// Says so when a value is not determined.
bool isDetermined(const Identification& found) {
  const Estimate* const open = found.undetermined();
  if (!open) return true;
  std::cerr << "identify: " << open->name << " = " << open->value << (open->unit.empty() ? "" : " ") << open->unit
            << ", interval [" << open->low << ", " << open->high << "]"
            << (open->bounded() ? "" : ", open " + open->open())
            << ": the record does not determine it: no scene is written\n";
  return false;
}

/// Writes what was found by each model; the first one's is the scene's. `source`: what it was found from. `curve`: of
/// the residuals; null: there are none.
int conclude(const IdentifyArguments& arguments, const std::string& source,
             const std::vector<std::pair<std::string, Identification>>& found, const ForceCurve* curve = nullptr) {
  std::string table = kEstimateColumns;
  for (const auto& [model, identification] : found) table += estimateRows(model, identification);
  const auto& [model, first] = found.front();
  flushStandardOutput();
  if (!arguments.csv.empty()) writeFileAtomically(arguments.csv, table);
  if (!arguments.residuals.empty()) writeFileAtomically(arguments.residuals, residualTable(*curve, first));
  if (!first.consistent()) {
    std::cerr << "identify: " << model << " does not follow the record: no scene is written\n";
    return kInconsistent;
  }
  if (!isDetermined(first)) return kUndetermined;
  if (!arguments.out.empty()) writeFileAtomically(arguments.out, identifiedScene(arguments.scene, source, first));
  return kFits;
}

int fitPoint(const IdentifyArguments& arguments, const std::optional<Scene>& scene) {
  std::vector<std::pair<std::string, Identification>> found;
  for (const std::string& model : arguments.models) {
    found.emplace_back(model,
                       identifyPoint(*arguments.point, *makeLaw(model, scene, arguments, arguments.point->depth)));
    printIdentification(model, found.back().second);
  }
  return conclude(arguments, "one point", found);
}

/// The columns that were named of one of the two kinds of records.
std::map<std::string, std::string> columnsOf(const IdentifyArguments& arguments, bool of_tongues) {
  std::map<std::string, std::string> columns = arguments.curve.columns;
  if (arguments.tongue.empty() || arguments.record.empty()) return columns;
  for (auto column = columns.begin(); column != columns.end();) {
    const bool is_of_tongues = column->first == "pressure" || column->first == "tongue";
    column = is_of_tongues == of_tongues ? std::next(column) : columns.erase(column);
  }
  return columns;
}

Identification fitTongue(const IdentifyArguments& arguments, const Scene& scene) {
  const std::map<std::string, std::string> columns = columnsOf(arguments, true);
  const TongueRecord record = arguments.vision ? measureTongues(arguments.tongue, columns, *arguments.vision)
                                               : readTongueRecord(readTextTable(arguments.tongue), columns);
  for (const std::string& note : record.notes) std::printf("%s: %s\n", arguments.tongue.c_str(), note.c_str());
  Identification found = identifyTongue(record, scene, TongueShape(scene));
  printIdentification("tongue", found);
  return found;
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
  if (scene && arguments.point) {
    ConfigErrors errors;
    PlausibleRange{"m", Range::closed(0, scene->cell.diameter())}.require("--point (DEPTH)", arguments.point->depth,
                                                                          errors);
    errors.throwAny();
  }
  if (arguments.point) return fitPoint(arguments, scene);
  std::optional<Identification> tongue;
  if (!arguments.tongue.empty()) tongue = fitTongue(arguments, *scene);
  if (arguments.record.empty()) return conclude(arguments, arguments.tongue, {{"tongue", *tongue}});
  ForceCurveConfig config = arguments.curve;
  config.columns = columnsOf(arguments, false);
  const ForceCurve curve = identifiedCurve(readForceCurve(arguments.record, config));
  if (tongue) scene = scene->glued();  // to a ring where the lip touches it: what a needle's force is known of
  std::vector<std::shared_ptr<ElasticLaw>> laws;
  for (const std::string& model : arguments.models) laws.push_back(makeLaw(model, scene, arguments, depthOf(curve)));
  for (const std::string& note : curve.notes) std::printf("%s: %s\n", arguments.record.c_str(), note.c_str());

  std::vector<std::pair<std::string, Identification>> fits;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    try {
      IdentificationConfig config = arguments.identification;
      // The force of a cell that suction holds is that of a glued one within this.
      if (tongue) config.calibration_error = std::hypot(config.calibration_error, Scene::kGluedError);
      if (arguments.models[i] == "family") {
        config.rivals =
            std::make_shared<const std::vector<RivalCell>>(rivalCells(loadFamilies(arguments.families), *scene));
      }
      fits.emplace_back(arguments.models[i], identify(curve, laws[i], config));
      printIdentification(arguments.models[i], fits.back().second);
    } catch (const ConfigError& error) {
      std::cerr << "identify: " << arguments.record << ": " << arguments.models[i] << ": " << error.what() << '\n';
      if (i == 0) return kFailed;
    }
  }
  if (fits.size() > 1) {
    std::vector<Identification> models;
    for (const auto& [model, fit] : fits) models.push_back(fit);
    const std::vector<double> criteria = informationCriteria(models);
    const auto best = std::min_element(criteria.begin(), criteria.end()) - criteria.begin();
    std::printf("the information criterion prefers: %s\n", fits[static_cast<std::size_t>(best)].first.c_str());
  }
  if (!tongue) return conclude(arguments, arguments.record, fits, &curve);
  const Identification& force = fits.front().second;
  if (!force.consistent() || !tongue->consistent()) {
    std::cerr << "identify: " << (force.consistent() ? "the tongues are not" : "the force is not")
              << " that of the scene's cell: the moduli are not joined\n";
    return kInconsistent;
  }
  fits.insert(fits.begin(), {"both", combineModuli(force, *tongue)});
  fits.emplace_back("tongue", *tongue);
  printIdentification("both", fits.front().second);
  return conclude(arguments, arguments.record + " and " + arguments.tongue, fits);
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runProgram("identify", [&] { return microinjection::run(argc, argv); });
}
