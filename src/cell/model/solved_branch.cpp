#include "cell/model/solved_branch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/cache_file.h"
#include "base/errors.h"
#include "cell/model/pierced_cell.h"
#include "cell/model/scene_description.h"
#include "cell/penetration/hole_expansion.h"

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
constexpr double kSmallestHole = 0.15, kLargestHole = 0.9;            // that the meshes can have
constexpr double kNearBorder = 0.25;                                  // of two layers, within which no hole ends
const std::vector<double> kBelowBorder = {kNearBorder, 0.5, 1, 1.5};  // that holes end, too
constexpr double kRounding = 1e-9;
constexpr std::size_t kMostHoles = 100;
constexpr double kCohesiveStep = 0.05;
constexpr double kSmallestLayer = 2;                              // radius of the innermost one
constexpr double kDrop = 0.98;                                    // of the largest force: the strength is reached
constexpr double kSmallestOpening = 0.03, kLargestOpening = 0.2;  // the latter of R - b, that a hole opens by
constexpr int kVersion = 5;                                       // of what is stored

double modulusOf(const Scene& scene) { return scene.cell.material().young_modulus; }

/// The cell over its tip's radius and the modulus of its outermost layer.
PiercedCellConfig configOf(const Scene& scene, const SteadyPenetration& steady, double level) {
  PiercedCellConfig config;
  const double tip = scene.needle.tip.radius, modulus = modulusOf(scene);
  config.layers = scene.cell.layers;
  for (Scene::Layer& layer : config.layers) {
    layer.outer_radius /= tip;
    layer.material.young_modulus /= modulus;
    layer.surface_tension /= modulus * tip;
  }
  config.held_radius = scene.holding_pipette.contact_radius / tip;
  config.tip_radius = 1;
  config.hole_radius = steady.hole_radius;
  config.level = level;
  return config;
}

/// Of holes, in tip radii: none ends near the border of two layers, and several do below it, where the tip's round end
/// still is in the layer above.
std::vector<double> lengthsOf(const PiercedCellConfig& config) {
  std::vector<double> wanted = kLengths, lengths;
  const double radius = config.radius();
  const double longest = std::min(kLongest * radius, radius + 0.8 * config.layers.back().outer_radius);
  const auto nearBorder = [&](double length) {
    return std::any_of(config.layers.begin() + 1, config.layers.end(), [&](const Scene::Layer& layer) {
      const double inner = layer.outer_radius, on_axis = radius - inner;
      const double on_wall = radius - std::sqrt(inner * inner - config.hole_radius * config.hole_radius);
      return length > on_axis - kNearBorder && length < on_wall + kNearBorder - kRounding;
    });
  };
  for (std::size_t i = 1; i < config.layers.size(); ++i) {
    const double inner = config.layers[i].outer_radius, hole = config.hole_radius;
    wanted.push_back(radius - inner - kNearBorder);
    for (const double below : kBelowBorder) wanted.push_back(radius - std::sqrt(inner * inner - hole * hole) + below);
  }
  std::sort(wanted.begin(), wanted.end());
  for (const double length : wanted) {
    const bool apart = lengths.empty() || length > lengths.back() + kNearBorder - kRounding;
    if (length >= kLengths.front() && length < longest && apart && !nearBorder(length)) lengths.push_back(length);
  }
  return lengths;
}

bool relaxAlike(const ViscoelasticityConfig& one, const ViscoelasticityConfig& other) {
  return std::equal(one.prony.begin(), one.prony.end(), other.prony.begin(), other.prony.end(),
                    [](const PronyTerm& a, const PronyTerm& b) {
                      return a.modulus_ratio == b.modulus_ratio && a.relaxation_time == b.relaxation_time;
                    });
}

void requirePierceable(const Scene& scene) {
  const std::string at = "cell/puncture/layers/0/toughness: ";
  if (scene.cell.tensegrity) throw ConfigError(at + "a tensegrity is not pierced by mechanics; give it a force");
  const int tough = scene.cell.puncture.toughLayers(), layers = static_cast<int>(scene.cell.layers.size());
  if (tough != layers)
    throw ConfigError("cell/puncture/layers: " + std::to_string(tough) + " have a toughness, but the cell has " +
                      std::to_string(layers) + " layers, of which each needs one");
  if (layers > 1 && scene.cell.puncture.shaft.coefficient > 0)
    throw ConfigError(
        "cell/puncture/shaft/coefficient: must be left out of a cell with layers: how each presses on the shaft is not "
        "known");
  if (layers > 1 && scene.needle.tip.taper > 0)
    throw ConfigError("needle/tip/taper: must be left out of a cell with layers");
  if (scene.cell.layers.back().outer_radius < kSmallestLayer * scene.needle.tip.radius)
    throw ConfigError(at + "the innermost layer is smaller than two radii of the tip");
  if (scene.needle.tip.shape != "hemisphere")
    throw ConfigError(at + "needle/tip/shape must be hemisphere, not " + scene.needle.tip.shape +
                      ", for a cell that is pierced by mechanics");
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (!makeMaterial(layer.material)->resistsInversion())
      throw ConfigError(at + "the material " + layer.material.model +
                        " has no limit of compression and cannot be pierced; use neo_hookean, ogden or gent");
    if (!relaxAlike(layer.material.viscoelasticity, scene.cell.material().viscoelasticity))
      throw ConfigError(at + "layers that do not relax alike are not pierced by mechanics");
  }
}

/// The strength gives the crack a size: it must be one that the meshes show, and the hole must open wide enough.
void requireCohesion(const Scene& scene, double hole_radius) {
  const double opening = scene.cell.puncture.opening() / scene.needle.tip.radius;
  const Scene::Contact& contact = scene.needle.contact;
  if (opening == 0) return;
  std::ostringstream message;
  message << "cell/puncture/layers/0/strength = " << scene.cell.puncture.layers.front().strength << " Pa: ";
  if (contact.mode != "sliding" || contact.friction != 0)
    throw ConfigError(message.str() + "needle/contact/mode must be sliding, without friction");
  if (scene.cell.layers.size() > 1 || scene.cell.layers.front().surface_tension > 0)
    throw ConfigError(message.str() + "the cell must be homogeneous, without surface tension");
  const double largest = kLargestOpening * (1 - hole_radius);
  if (opening >= kSmallestOpening && opening <= largest) return;
  const double strength = scene.cell.puncture.layers.front().strength;
  message << "a crack would have its largest traction where it is open by " << opening
          << " of the tip's radius; allowed are " << kSmallestOpening << " to " << largest << ", which are "
          << strength * opening / largest << " to " << strength * opening / kSmallestOpening << " Pa";
  throw ConfigError(message.str());
}

std::vector<Knot> wholePath(PiercedCellConfig config, const Scene::Contact& contact) {
  config.hole_length = 0;
  config.sticking = contact.mode == "sticking";
  config.friction = contact.friction;
  PiercedCell cell(config);
  std::vector<Knot> knots = {{0, 0, 0}};
  for (double depth = kStep; depth <= kDeepest * config.radius() && cell.advance(depth); depth += kStep)
    knots.push_back({depth, cell.force(), cell.energy()});
  return knots;
}

/// To where the wall at its mouth has opened beyond its strength and the force is largest, or no equilibrium is stable.
std::vector<Knot> cohesivePath(PiercedCellConfig config, const PiercedCellConfig::Cohesion& cohesion, double longest) {
  config.hole_length = longest;
  config.cohesion = cohesion;
  PiercedCell cell(config);
  std::vector<Knot> knots = {{0, 0, 0}};
  bool more = true;
  while (more && knots.back().beyond < config.radius()) {
    more = cell.advance(knots.back().beyond + kCohesiveStep);
    if (cell.force() < knots.back().force) break;
    if (cell.depth() - knots.back().beyond > kClosest * kCohesiveStep)
      knots.push_back({cell.depth(), cell.force(), cell.energy()});
  }
  if (cell.mouthOpening() < cohesion.opening)
    throw ConfigError(
        "cell/puncture/layers/0/strength: the whole cell is not solved to where it is exceeded, but to a depth of " +
        std::to_string(cell.depth()) + " tip radii: " + (more ? "no drop of the force" : cell.reason()));
  return knots;
}

/// Recorded on the way out, to the last equilibrium before the needle leaves the hole: there the force rises, or more
/// energy is lost than by wrinkles that straighten. Empty when the needle does not stay in.
std::vector<Knot> holePath(const PiercedCellConfig& config, double highest, double pressing) {
  std::optional<PiercedCell> made;
  try {
    made.emplace(config);
  } catch (const NotAtRest&) {
    return {};
  }
  PiercedCell& cell = *made;
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

/// N over the modulus and square of the tip's radius: with which the steady hole's wall and crack resist at the bottom
/// of a hole of this length.
double resistanceAt(double length, const PiercedCellConfig& config, const PunctureConfig& puncture, double unit) {
  std::size_t layer = 0;
  while (layer + 1 < config.layers.size() && config.layers[layer + 1].outer_radius > config.radius() - length) ++layer;
  const int tough = std::min(static_cast<int>(layer), puncture.toughLayers() - 1);
  const auto material = makeMaterial(config.layers[layer].material);
  return HoleExpansion(*material, config.radius()).at(config.hole_radius).energy +
         2 * M_PI * config.hole_radius * puncture.layers[tough].toughness / unit;
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
  const double tip = scene.needle.tip.radius, force = modulusOf(scene) * tip * tip;
  const PunctureConfig& puncture = scene.cell.puncture;
  const std::vector<double> lengths = lengthsOf(config);
  const int count = static_cast<int>(lengths.size()) + 1;
  if (report) report(0, count);
  PiercedPaths paths;
  if (puncture.opening() > 0) {
    const PiercedCellConfig::Cohesion cohesion{puncture.layers.front().toughness / (modulusOf(scene) * tip),
                                               puncture.opening() / tip};
    paths.whole = cohesivePath(config, cohesion, lengths.back());
    paths.gives_way = tip * paths.whole.back().beyond;
  } else {
    paths.whole = wholePath(config, scene.needle.contact);
  }
  for (int i = 0; i + 1 < count; ++i) {
    if (report) report(i + 1, count);
    config.hole_length = lengths[i];
    Hole hole{lengths[i], {}};
    const double highest = kHighest * resistanceAt(lengths[i], config, puncture, modulusOf(scene) * tip);
    for (const double pressing : kPressing) {
      if (hole.knots.empty()) hole.knots = holePath(config, highest, pressing);
    }
    if (!hole.knots.empty()) paths.holes.push_back(std::move(hole));
  }
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
  out << paths.gives_way << '\n';
  return out.str();
}

std::optional<PiercedPaths> pathsOf(const std::string& text) {
  std::istringstream in(text);
  PiercedPaths paths;
  std::size_t count = 0;
  if (!read(in, paths.whole) || !(in >> count) || count > kMostHoles) return std::nullopt;
  paths.holes.resize(count);
  for (Hole& hole : paths.holes) {
    if (!(in >> hole.length) || !read(in, hole.knots)) return std::nullopt;
  }
  if (!(in >> paths.gives_way)) return std::nullopt;
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
  requireCohesion(scene, best.hole_radius);
  return best;
}

namespace {

/// 3 tip radii behind the onset.
struct FurtherOn {
  double length = 0, force = 0;  ///< m, N
};

FurtherOn furtherOn(const PiercedBranch& branch, double tip) {
  double depth = branch.onset()->depth, length = branch.onset()->length;
  for (int i = 0; i < 12; ++i) length = branch.grown(depth += tip / 4, length);
  return {length, branch.at(depth, length).force};
}

}  // namespace

std::optional<double> distanceFromLongHole(const PiercedBranch& branch, const Scene& scene) {
  if (!branch.onset()) return std::nullopt;
  const double tip = scene.needle.tip.radius, modulus = modulusOf(scene);
  const FurtherOn further = furtherOn(branch, tip);
  const double steady = modulus * tip * tip *
                        resistanceAt(further.length / tip, configOf(scene, steadyPenetration(scene), 0),
                                     scene.cell.puncture, modulus * tip);
  return std::abs(further.force / steady - 1);
}

std::string describePuncture(const PiercedBranch& branch, const Scene& scene) {
  const auto& onset = branch.onset();
  if (!onset) return "no depth that is solved pierces it";
  char text[200];
  std::snprintf(text, sizeof text,
                "pierced at %.3g uN in a dent of %.3g um, then %.3g uN for the hole alone, which is %.2g %% from that "
                "of a long one",
                1e6 * onset->force, 1e6 * onset->depth, 1e6 * furtherOn(branch, scene.needle.tip.radius).force,
                100 * *distanceFromLongHole(branch, scene));
  return text;
}

PiercedBranch branchOf(PiercedPaths paths, const Scene& scene) {
  const SteadyPenetration steady = steadyPenetration(scene);
  const PunctureConfig::Layer& layer = scene.cell.puncture.layers.front();
  if (paths.holes.size() < 2)
    throw ConfigError(
        "cell/puncture/layers/0/toughness: the cell with a hole has no equilibrium with the needle in it");
  const double around = 2 * M_PI * scene.needle.tip.radius;
  PiercedBranch::Crack crack;
  crack.parts.clear();
  for (int i = 0; i < scene.cell.puncture.toughLayers(); ++i)
    crack.parts.push_back({scene.radius() - scene.cell.layers[i].outer_radius,
                           around * steady.hole_radius * scene.cell.puncture.layers[i].toughness});
  crack.barrier = layer.barrier;
  crack.wall_force = around * steady.wall_pressure;
  crack.gives_way = paths.gives_way;
  crack.hole_radius = steady.hole_radius * scene.needle.tip.radius;
  return PiercedBranch(std::move(paths.whole), std::move(paths.holes), std::move(crack));
}

PiercedBranch solvePiercedBranch(const Scene& scene, double level, const std::function<void(int, int)>& report) {
  const SteadyPenetration steady = steadyPenetration(scene);
  return branchOf(solvePaths(scene, steady, level, report), scene);
}

PiercedBranch storedPiercedBranch(const Scene& scene, const std::function<void(int, int)>& report) {
  const SteadyPenetration steady = steadyPenetration(scene);
  std::ostringstream description;
  description.precision(17);
  description << "pierced branch " << kVersion << ", hole " << steady.hole_radius << ", ";
  if (scene.cell.puncture.opening() > 0)  // else the paths do not depend on what a crack costs
    description << "toughness " << scene.cell.puncture.layers.front().toughness << ", opening "
                << scene.cell.puncture.opening() << ", ";
  for (int i = 1; i < scene.cell.puncture.toughLayers(); ++i)  // by which long holes are followed
    description << "toughness behind it " << scene.cell.puncture.layers[i].toughness << ", ";
  description << describeCellAndTip(scene);
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
