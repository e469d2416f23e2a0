// Each member of the families, predicted from the others: by polynomials and by kriging, with and without the axis.

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_data.h"
#include "cell/family/family_file.h"

namespace microinjection {
namespace {

/// The powers of the coordinates up to a total degree.
Eigen::VectorXd powers(const Eigen::VectorXd& x, int degree) {
  std::vector<double> result = {1};
  std::vector<int> next = {0};  // first coordinate that each may still be multiplied by
  for (std::size_t i = 0, order = 0; static_cast<int>(order) < degree; ++order) {
    for (const std::size_t end = result.size(); i < end; ++i) {
      for (int k = next[i]; k < x.size(); ++k) {
        result.push_back(result[i] * x[k]);
        next.push_back(k);
      }
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(result.data(), static_cast<Eigen::Index>(result.size()));
}

/// Weights (rows) with which the least-squares polynomial through all other points predicts each.
Eigen::MatrixXd polynomial(const Eigen::MatrixXd& points, int degree) {
  const Eigen::Index count = points.cols();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd at = powers(points.col(i), degree);
    Eigen::MatrixXd others = Eigen::MatrixXd::Zero(count, at.size());  // a row of zeros has no influence
    for (Eigen::Index j = 0; j < count; ++j) {
      if (j != i) others.row(j) = powers(points.col(j), degree).transpose();
    }
    result.row(i) = others.transpose().completeOrthogonalDecomposition().solve(at).transpose();
  }
  return result;
}

std::string row(const Family& family, const char* name, const char* scale, const LeaveOneOut& left_out,
                const Eigen::MatrixXd& weights) {
  std::vector<double> errors;
  for (const std::vector<double>& member : left_out.errors(weights)) {
    errors.insert(errors.end(), member.begin(), member.end());
  }
  char line[200];
  std::snprintf(line, sizeof(line), "%s,%s,%s,%.4f,%.4f,%.4f\n", family.name().c_str(), name, scale,
                quantile(errors, 0.5), quantile(errors, 0.9), quantile(errors, 1));
  std::fputs(line, stdout);
  return line;
}

std::string rowsOf(const std::string& name) {
  const std::string file = MICROINJECTION_SOURCE_DIR "/config/families/" + name + ".yaml";
  const Family family = Family::load(file);
  const auto data = FamilyData::load(family, familyDataFile(file));
  if (!data) {
    std::fprintf(stderr, "family_prediction: %s\n", data.reason.c_str());
    return "";
  }
  const auto count = static_cast<Eigen::Index>(data.content->members().size());
  const Eigen::MatrixXd points = data.content->knownPoints().leftCols(count);
  std::vector<double> scales;
  for (const FamilyMember& member : data.content->members()) scales.push_back(member.scale);
  std::string rows;
  for (const bool axis : {false, true}) {
    const LeaveOneOut left_out(family, data.content->members(), axis ? scales : std::vector<double>());
    const char* scale = axis ? "axis" : "interpolated";
    rows += row(family, "polynomial of degree 2", scale, left_out, polynomial(points, 2));
    rows += row(family, "polynomial of degree 3", scale, left_out, polynomial(points, 3));
    const Covariance best = chooseCovariance(points, [&](const auto& weights) { return left_out.errors(weights); });
    rows += row(family, "kriging", scale, left_out, Kriging(points, best.lengths, best.noise).leaveOneOut());
  }
  return rows;
}

std::string table() {
  std::string rows = "family,prediction,size_of_the_force,force_error_median,force_error_common,force_error_largest\n";
  std::fputs(rows.c_str(), stdout);
  for (const char* name : {"homogeneous", "zona"}) rows += rowsOf(name);
  return rows;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv,
                                   "bench_family_prediction: each member of the families, predicted from the others.",
                                   microinjection::table);
}
