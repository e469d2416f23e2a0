#include "cell/family/pierced_family.h"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/model/solved_branch.h"

namespace microinjection {
namespace {

using Knot = PiercedBranch::Knot;

// In tip radii.
const std::vector<double> kHoleLengths = {0.75, 1, 1.25, 1.75, 2.5, 4, 6};
constexpr int kKnots = 32;
constexpr double kApart = 0.25, kFirstBeyond = -2.5;

// Columns of a member: logarithms of the forces before and behind the onset, for the errors; where each hole's path
// begins, a row for each; then force and energy of the whole cell and of each hole. Forces over E R^2, energies over E
// R^3, with the tip's radius R.
constexpr int kWholeError = 0, kPiercedError = 1, kBegins = 2, kForces = 3;

int columns() { return kForces + 2 * (1 + static_cast<int>(kHoleLengths.size())); }
double depthOf(int knot) { return kApart * (knot + 1); }
double beyondOf(int knot) { return kFirstBeyond + kApart * knot; }

struct Units {
  double length, force;
  explicit Units(const Scene& scene)
      : length(scene.needle.tip.radius), force(scene.cell.material().young_modulus * length * length) {}
};

Knot knotOf(const Eigen::MatrixXd& curves, int row, int column, double place, const Units& units) {
  return {units.length * place, units.force * curves(row, column),
          units.force * units.length * curves(row, column + 1)};
}

/// From where the members' paths begin, to the next knot.
std::vector<Knot> holeKnots(const Eigen::MatrixXd& curves, int hole, const Units& units) {
  std::vector<Knot> knots;
  for (int i = 0; i < kKnots; ++i) {
    if (beyondOf(i) > curves(hole, kBegins) - kApart / 2 || i + 2 >= kKnots)
      knots.push_back(knotOf(curves, i, kForces + 2 + 2 * hole, beyondOf(i), units));
  }
  return knots;
}

}  // namespace

SectionMember solvePierced(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  const Scene scene = family.member(coordinates);
  const PiercedBranch branch = solvePiercedBranch(scene);
  if (!branch.onset()) throw std::runtime_error("no depth that is solved pierces it");
  const Units units(scene);
  SectionMember member{coordinates, Eigen::MatrixXd(kKnots, columns())};
  const auto set = [&](int knot, int column, const PiercedBranch::State& state) {
    member.curves(knot, column) = state.force / units.force;
    member.curves(knot, column + 1) = state.energy / (units.force * units.length);
  };
  double depth = branch.onset()->depth, length = branch.onset()->length;
  for (int i = 0; i < kKnots; ++i) {
    const PiercedBranch::State whole = branch.whole(units.length * depthOf(i));
    set(i, kForces, whole);
    member.curves(i, kWholeError) = std::log(whole.force / units.force);
    member.curves(i, kPiercedError) = std::log(branch.at(depth, length).force / units.force);
    length = branch.grown(depth += units.length * kApart / 2, length);
    member.curves(i, kBegins) = 0;
    for (std::size_t k = 0; k < kHoleLengths.size(); ++k) {
      const double hole = units.length * kHoleLengths[k];
      set(i, kForces + 2 + 2 * static_cast<int>(k), branch.at(hole + units.length * beyondOf(i), hole));
    }
  }
  for (std::size_t k = 0; k < kHoleLengths.size(); ++k) {
    double begins = beyondOf(0);
    for (const PiercedBranch::Hole& hole : branch.holes()) {
      const bool near = hole.length <= branch.shortest() || hole.length <= 1.001 * units.length * kHoleLengths[k];
      if (near) begins = hole.knots.front().beyond / units.length;
    }
    member.curves(static_cast<Eigen::Index>(k), kBegins) = begins;
  }
  if (!member.curves.allFinite()) throw std::runtime_error("a force on the way in is not positive");
  return member;
}

PiercedFamily::PiercedFamily(SectionFamilyData data) : data_(std::move(data)) {
  if (data_.family().kind() != SectionFamily::Kind::kPierced)
    throw std::invalid_argument("family " + data_.family().name() + " has no pierced cells");
  for (const SectionMember& member : data_.members()) {
    if (member.curves.rows() != kKnots || member.curves.cols() != columns())
      throw ConfigError("family " + data_.family().name() + ": its data have other curves than pierced cells");
  }
}

FamilyBranch PiercedFamily::branch(const Scene& scene) const {
  const SectionFamilyData::Prediction found = data_.predict(data_.coordinatesOf(scene));
  const Units units(scene);
  PiercedPaths paths;
  paths.whole = {{0, 0, 0}};
  for (int i = 0; i < kKnots; ++i) paths.whole.push_back(knotOf(found.curves, i, kForces, depthOf(i), units));
  for (std::size_t k = 0; k < kHoleLengths.size(); ++k)
    paths.holes.push_back({units.length * kHoleLengths[k], holeKnots(found.curves, static_cast<int>(k), units)});
  return {branchOf(std::move(paths), scene), found.error[0], found.error[1]};
}

std::optional<FamilyBranch> findFamilyBranch(const std::string& families, const Scene& scene, std::string& reason) {
  return firstFamilyWith(families, "pierced", reason, [&](const std::string& file) {
    FamilyBranch found = PiercedFamily(SectionFamilyData::loadBoth(file)).branch(scene);
    if (!found.branch.onset())
      throw ConfigError("family " + file + ": nothing pierces the cell to the depth that it has");
    return found;
  });
}

}  // namespace microinjection
