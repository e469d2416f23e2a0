#include "cell/model/solved_branch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <vector>

#include "base/cache_file.h"
#include "base/errors.h"
#include "cell/model/pierced_cell.h"
#include "cell/model/scene_description.h"

namespace microinjection {
namespace {

using Knot = PiercedBranch::Knot;
using Hole = PiercedBranch::Hole;

// Lengths in radii of the tip, forces over the steady one.
const std::vector<double> kLengths = {0.75, 1, 1.25, 1.75, 2.5, 4, 6, 9, 13, 18};
const std::vector<double> kPressing = {1.05, 1.2, 1.5};  // tried for a needle that grows in its hole
constexpr double kStep = 0.25;
constexpr double kHighest = 2.4;   // force up to which holes are followed
constexpr double kBack = 2.5;      // from the bottom, to which the needle is withdrawn
constexpr double kLeap = 0.1;      // of the force, or of the work of a step, across an instability on the way out
constexpr double kClosest = 0.02;  // knots
constexpr double kLongest = 1.3;   // hole, of the cell's radius
constexpr double kDeepest = 1.7;   // needle in the whole cell, same
constexpr double kSmallestHole = 0.15, kLargestHole = 0.9;  // that the meshes can have
constexpr int kVersion = 3;                                 // of what is stored

double modulusOf(const Scene& scene) { return scene.cell.material().young_modulus; }

/// The cell over its tip's radius and modulus.
PiercedCellConfig configOf(const Scene& scene, const SteadyPenetration& steady, double level) {
  PiercedCellConfig config;
  config.material = scene.cell.material();
  config.material.young_modulus = 1;
  const double tip = scene.needle.tip.radius;
  config.radius = scene.radius() / tip;
  config.held_radius = scene.holding_pipette.contact_radius / tip;
  config.tip_radius = 1;
  config.hole_radius = steady.hole_radius;
  config.level = level;
  return config;
}

void requirePierceable(const Scene& scene) {
  const std::string at = "cell/puncture/layers/0/toughness: ";
  if (scene.cell.tensegrity || scene.cell.layers.size() != 1 || scene.cell.layers.front().surface_tension != 0)
    throw ConfigError(at + "only a homogeneous cell without surface tension is pierced by mechanics; give it a force");
  if (scene.needle.tip.shape != "hemisphere")
    throw ConfigError(at + "needle/tip/shape must be hemisphere, not " + scene.needle.tip.shape +
                      ", for a cell that is pierced by mechanics");
  const auto material = makeMaterial(scene.cell.material());
  if (!material->resistsInversion())
    throw ConfigError(at + "the material " + scene.cell.material().model +
                      " has no limit of compression and cannot be pierced; use neo_hookean, ogden or gent");
}

std::vector<Knot> wholePath(PiercedCellConfig config, const Scene::Contact& contact) {
  config.hole_length = 0;
  config.sticking = contact.mode == "sticking";
  config.friction = contact.friction;
  PiercedCell cell(config);
  std::vector<Knot> knots = {{0, 0, 0}};
  for (double depth = kStep; depth <= kDeepest * config.radius && cell.advance(depth); depth += kStep)
    knots.push_back({depth, cell.force(), cell.energy()});
  return knots;
}

/// Recorded on the way out, to the last equilibrium before the needle leaves the hole: there the force rises, or more
/// energy is lost than by wrinkles that straighten. Empty when the needle does not stay in.
std::vector<Knot> holePath(const PiercedCellConfig& config, double highest, double pressing) {
  PiercedCell cell(config);
  if (!cell.insert(highest, pressing)) return {};
  const double outermost = std::max(1 - config.hole_length, -kBack);
  std::vector<Knot> knots;
  const auto record = [&] { knots.push_back({cell.depth() - config.hole_length, cell.force(), cell.energy()}); };
  record();
  for (double next = knots.back().beyond; next > outermost;) {
    next = std::max(outermost, next - kStep);
    const bool smooth = cell.advance(config.hole_length + next);
    if (smooth || knots.back().beyond - (cell.depth() - config.hole_length) > kClosest) record();
    if (smooth) continue;
    const Knot last = knots.back();
    if (!cell.advanceAcross(config.hole_length + next) || !cell.isInside()) break;
    const double work = 0.5 * (last.force + cell.force()) * (last.beyond - next);
    if (cell.force() > (1 + kLeap) * last.force || last.energy - work - cell.energy() > kLeap * last.force * kStep)
      break;
    if (last.beyond - next > kClosest) record();
  }
  std::reverse(knots.begin(), knots.end());
  return knots.size() < 2 ? std::vector<Knot>() : knots;
}

void scale(std::vector<Knot>& knots, double length, double force) {
  for (Knot& knot : knots) {
    knot.beyond *= length;
    knot.force *= force;
    knot.energy *= force * length;
  }
}

PiercedPaths solvePaths(const Scene& scene, const SteadyPenetration& steady, double level,
                        const std::function<void(int, int)>& report) {
  PiercedCellConfig config = configOf(scene, steady, level);
  const double highest = kHighest * steady.force_in / modulusOf(scene);
  std::vector<double> lengths;
  for (const double length : kLengths) {
    if (length < kLongest * config.radius) lengths.push_back(length);
  }
  const int count = static_cast<int>(lengths.size()) + 1;
  if (report) report(0, count);
  PiercedPaths paths;
  paths.whole = wholePath(config, scene.needle.contact);
  for (int i = 0; i + 1 < count; ++i) {
    if (report) report(i + 1, count);
    config.hole_length = lengths[i];
    Hole hole{lengths[i], {}};
    for (const double pressing : kPressing) {
      if (hole.knots.empty()) hole.knots = holePath(config, highest, pressing);
    }
    if (!hole.knots.empty()) paths.holes.push_back(std::move(hole));
  }
  const double tip = scene.needle.tip.radius, force = modulusOf(scene) * tip * tip;
  scale(paths.whole, tip, force);
  for (Hole& hole : paths.holes) {
    hole.length *= tip;
    scale(hole.knots, tip, force);
  }
  return paths;
}

void write(std::ostream& out, const std::vector<Knot>& knots) {
  out << knots.size() << '\n';
  for (const Knot& knot : knots) out << knot.beyond << ' ' << knot.force << ' ' << knot.energy << '\n';
}

bool read(std::istream& in, std::vector<Knot>& knots) {
  std::size_t count = 0;
  if (!(in >> count) || count > 10000) return false;
  knots.resize(count);
  for (Knot& knot : knots) in >> knot.beyond >> knot.force >> knot.energy;
  return static_cast<bool>(in);
}

std::string textOf(const PiercedPaths& paths) {
  std::ostringstream out;
  out.precision(17);
  write(out, paths.whole);
  out << paths.holes.size() << '\n';
  for (const Hole& hole : paths.holes) {
    out << hole.length << ' ';
    write(out, hole.knots);
  }
  return out.str();
}

std::optional<PiercedPaths> pathsOf(const std::string& text) {
  std::istringstream in(text);
  PiercedPaths paths;
  std::size_t count = 0;
  if (!read(in, paths.whole) || !(in >> count) || count > kLengths.size()) return std::nullopt;
  paths.holes.resize(count);
  for (Hole& hole : paths.holes) {
    if (!(in >> hole.length) || !read(in, hole.knots)) return std::nullopt;
  }
  return paths;
}

}  // namespace

bool piercedByMechanics(const Scene& scene) {
  const auto& layers = scene.cell.puncture.layers;
  return !layers.empty() && std::isfinite(layers.front().toughness);
}

SteadyPenetration steadyPenetration(const Scene& scene) {
  requirePierceable(scene);
  const double tip = scene.needle.tip.radius;
  const DeepPenetration deep(scene.cell.material(), scene.radius() / tip);
  const SteadyPenetration best = deep.steady(scene.cell.puncture.layers.front().toughness / tip);
  if (best.hole_radius < kSmallestHole || best.hole_radius > kLargestHole) {
    std::ostringstream message;
    message << "cell/puncture/layers/0/toughness = " << scene.cell.puncture.layers.front().toughness
            << " J/m^2: the hole would have " << best.hole_radius << " of the tip's radius, allowed are "
            << kSmallestHole << " to " << kLargestHole << ": "
            << (best.hole_radius < kSmallestHole ? "a material that stiffens more (ogden, gent), or a smaller toughness"
                                                 : "a larger toughness");
    throw ConfigError(message.str());
  }
  return best;
}

std::string describePuncture(const PiercedBranch& branch, const Scene& scene) {
  const auto& onset = branch.onset();
  if (!onset) return "no depth that is solved pierces it";
  const double tip = scene.needle.tip.radius, steady = steadyPenetration(scene).force_in * tip * tip;
  double depth = onset->depth, length = onset->length;
  for (int i = 0; i < 12; ++i) length = branch.grown(depth += tip / 4, length);
  const double force = branch.at(depth, length).force;
  char text[200];
  std::snprintf(text, sizeof text,
                "pierced at %.3g uN in a dent of %.3g um, then %.3g uN for the hole alone, which is %.2g %% from that "
                "of a long one",
                1e6 * onset->force, 1e6 * onset->depth, 1e6 * force, 100 * std::abs(force / steady - 1));
  return text;
}

PiercedBranch branchOf(PiercedPaths paths, const Scene& scene) {
  const SteadyPenetration steady = steadyPenetration(scene);
  const PunctureConfig::Layer& layer = scene.cell.puncture.layers.front();
  if (paths.holes.size() < 2)
    throw ConfigError(
        "cell/puncture/layers/0/toughness: the cell with a hole has no equilibrium with the needle in it");
  const double around = 2 * M_PI * scene.needle.tip.radius;
  return PiercedBranch(std::move(paths.whole), std::move(paths.holes), around * steady.hole_radius * layer.toughness,
                       layer.barrier, around * steady.wall_pressure);
}

PiercedBranch solvePiercedBranch(const Scene& scene, double level, const std::function<void(int, int)>& report) {
  const SteadyPenetration steady = steadyPenetration(scene);
  return branchOf(solvePaths(scene, steady, level, report), scene);
}

PiercedBranch storedPiercedBranch(const Scene& scene, const std::function<void(int, int)>& report) {
  const SteadyPenetration steady = steadyPenetration(scene);
  std::ostringstream description;
  description.precision(17);
  description << "pierced branch " << kVersion << ", hole " << steady.hole_radius << ", " << describeCellAndTip(scene);
  const std::string folder = cacheDirectory("pierced");
  const std::string path = folder.empty() ? "" : folder + "/" + contentHash(description.str()) + ".txt";
  if (!path.empty()) {
    if (const CacheRead<std::string> stored = readCacheFile(path, description.str())) {
      if (std::optional<PiercedPaths> paths = pathsOf(*stored.content)) return branchOf(std::move(*paths), scene);
    }
  }
  PiercedPaths paths = solvePaths(scene, steady, 0, report);
  if (!path.empty()) {
    try {
      writeCacheFile(path, description.str(), textOf(paths));
    } catch (const WriteError&) {  // a full or read-only disk: it is solved again next time
    }
  }
  return branchOf(std::move(paths), scene);
}

}  // namespace microinjection
