#include "commands/identify_report.h"

#include <cstdio>

namespace microinjection {
namespace {

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

}  // namespace

void printIdentification(const std::string& model, const Identification& found) {
  std::printf("%s: %s\n", model.c_str(), found.model.c_str());
  for (const Estimate& estimate : found.estimates) {
    std::printf("  %-18s %12.5g %-5s 95 %% interval [%.5g, %.5g]%s\n", estimate.name.c_str(), estimate.value,
                estimate.unit.c_str(), estimate.low, estimate.high, estimate.bounded ? "" : ", open on one side");
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
                  estimate.value, estimate.low, estimate.high, estimate.unit.c_str(), estimate.bounded);
    rows += row;
  }
  return rows;
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

}  // namespace microinjection
