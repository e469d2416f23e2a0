// Puncture by mechanics: steady penetration against its closed balance of energy, onset and branches of four cells, the
// paper's; shells, and cells with a strength.

#include <boost/math/special_functions/fpclassify.hpp>

#include <algorithm>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "cell/family/pierced_family.h"
#include "cell/model/pierced_cell.h"
#include "cell/model/piezo_stroke.h"
#include "cell/model/solved_branch.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {
namespace {

constexpr double kShear = 1;  // Pa
constexpr double kTip = 3e-6;

MaterialConfig softSolid(const std::string& model, double parameter, double poisson_ratio, double shear = kShear) {
  MaterialConfig material;
  material.model = model;
  material.poisson_ratio = poisson_ratio;
  material.young_modulus = 2 * (1 + poisson_ratio) * shear;
  if (model == "ogden") material.ogden_exponent = parameter;
  if (model == "gent") material.gent_limit = parameter;
  return material;
}

/// W over the shear modulus of a sheared circle with stretches s, 1 / s, 1.
double closedEnergy(const std::string& model, double parameter, double s) {
  const double first = s * s + 1 / (s * s) - 2;
  if (model == "neo_hookean") return first / 2;
  if (model == "gent") return first < parameter ? -parameter / 2 * std::log1p(-first / parameter) : HUGE_VAL;
  return 2 / (parameter * parameter) * (std::pow(s, parameter) + std::pow(s, -parameter) - 2);
}

/// p / mu of an incompressible block: the hole's energy by quadrature over the stretch s of its circles. With
/// rho^2 (s^2 - 1) = 1 - x^2, the area 2 pi rho d rho is 2 pi (1 - x^2) s / (s^2 - 1)^2 ds.
double closedPressure(const std::string& model, double parameter, double toughness) {
  boost::math::quadrature::tanh_sinh<double> rule;
  const auto energy = [&](double x) {
    if (!std::isfinite(closedEnergy(model, parameter, 1 / x))) return HUGE_VAL;
    const auto density = [&](double t) {  // t = s - 1, which is small far away
      const double s = 1 + t, square = t * (2 + t);
      return closedEnergy(model, parameter, s) * 2 * (1 - x * x) * s / (square * square);
    };
    return rule.integrate(density, 1e-4, 1 / x - 1) + 0.5 * (1 - x * x) * 1e-4;  // W is 2 t^2 mu near t = 0
  };
  const auto total = [&](double x) { return energy(x) + 2 * x * toughness; };
  double low = 0.01, best = HUGE_VAL, at = 0.5;
  for (double x = low; x < 0.999; x += 0.01) {
    if (total(x) < best) {
      best = total(x);
      at = x;
    }
  }
  return boost::math::tools::brent_find_minima(total, at - 0.0099, std::min(at + 0.01, 0.9999), 24).second;
}

void steady(PrintedTable& table) {
  table.add("study,law,parameter,toughness_over_mu_R,pressure_over_mu,closed,apart_percent,hole_over_R\n");
  struct Law {
    const char* name;
    double parameter;
  };
  for (const Law& law : {Law{"neo_hookean", 2}, {"ogden", 3}, {"ogden", 5}, {"ogden", 9}, {"gent", 10}, {"gent", 50}}) {
    for (const double toughness : {0.1, 1.0, 10.0, 50.0}) {
      const DeepPenetration deep(softSolid(law.name, law.parameter, 0.49999));
      const SteadyPenetration found = deep.steady(toughness * kShear);
      const double closed = closedPressure(law.name, law.parameter, toughness), own = found.force_in / M_PI / kShear;
      char row[200];
      std::snprintf(row, sizeof row, "steady,%s,%g,%g,%.5g,%.5g,%.4f,%.4f\n", law.name, law.parameter, toughness, own,
                    closed, 100 * (own / closed - 1), found.hole_radius);
      table.add(row);
    }
  }
}

struct SoftCell {
  const char* name;
  const char* model;
  double parameter, radius, held, toughness;  // radii in tip radii; over mu R
};

constexpr SoftCell kCells[] = {{"A", "neo_hookean", 0, 10, 3, 1},
                               {"B", "neo_hookean", 0, 8, 4, 0.4},
                               {"C", "ogden", 4, 8, 3, 2},
                               {"D", "gent", 10, 10, 3, 2}};

Scene sceneOf(const SoftCell& cell, double shear = 1e3) {
  Scene scene;
  scene.cell.layers[0].outer_radius = cell.radius * kTip;
  scene.cell.material() = softSolid(cell.model, cell.parameter, 0.49, shear);
  scene.needle.tip = {"hemisphere", kTip, 0};
  scene.needle.contact.mode = "sliding";
  scene.holding_pipette.contact_radius = cell.held * kTip;
  scene.cell.puncture.layers.emplace_back().toughness = cell.toughness * shear * kTip;
  return scene;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// What the needle feels on its way in, along the crack that grows with it.
void writeWay(PrintedTable& table, const char* name, const PiercedBranch& branch, double force) {
  const PiercedBranch::Onset onset = *branch.onset();
  double length = onset.length;
  for (double depth = 0; depth < onset.depth + 6 * kTip; depth += kTip / 4) {
    const bool in = depth >= onset.depth;
    if (in) length = branch.grown(depth, length);
    const PiercedBranch::State state = in ? branch.at(depth, length) : branch.whole(depth);
    char row[200];
    std::snprintf(row, sizeof row, "way,%s,%.4g,%.4g,%.4g,%.4g\n", name, depth / kTip, state.force / force,
                  in ? length / kTip : 0, branch.whole(depth).force / force);
    table.add(row);
  }
}

void branches(PrintedTable& table, double level) {
  table.add("study,cell,depth_over_R,force,hole_over_R,force_of_the_whole_cell\n");
  table.add(
      "study,cell,law,parameter,radius,held,toughness_over_mu_R,level,hole_over_R,onset_depth_over_R,onset_force,"
      "pierced_"
      "force,steady_force,closed_steady_force,seconds\n");
  for (const SoftCell& cell : kCells) {
    const Scene scene = sceneOf(cell);
    const double unit = M_PI * kTip * kTip * 1e3, begin = now();  // forces over pi R^2 mu
    const PiercedBranch branch = solvePiercedBranch(scene, level);
    const double took = now() - begin;
    const SteadyPenetration deep = steadyPenetration(scene);
    if (!branch.onset()) {
      table.add(std::string("branches,") + cell.name + ",no onset on the path that is solved\n");
      continue;
    }
    const PiercedBranch::Onset onset = *branch.onset();
    double on = onset.depth, length = onset.length;
    for (int i = 0; i < 12; ++i) length = branch.grown(on += kTip / 4, length);
    char row[300];
    std::snprintf(row, sizeof row, "branches,%s,%s,%g,%g,%g,%g,%g,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.0f\n", cell.name,
                  cell.model, cell.parameter, cell.radius, cell.held, cell.toughness, level, deep.hole_radius,
                  onset.depth / kTip, onset.force / unit, onset.pierced_force / unit,
                  branch.at(on, length).force / unit, deep.force_in * kTip * kTip / unit, took);
    table.add(row);
    writeWay(table, cell.name, branch, unit);
  }
}

/// Onset of the four cells where their material has a strength, J / (e d): to compare with a second solver's cohesive
/// zone of the same opening d.
void cohesive(PrintedTable& table, double level) {
  table.add(
      "study,cell,opening_over_R,strength_over_mu,hole_over_R,onset_depth_over_R,onset_force,pierced_force,seconds\n");
  struct Wall {
    int cell;
    double opening;
  };
  for (const Wall& wall : {Wall{0, 0.08}, {1, 0.04}, {2, 0.08}, {3, 0.08}}) {
    const SoftCell& cell = kCells[wall.cell];
    Scene scene = sceneOf(cell);
    PunctureConfig::Layer& layer = scene.cell.puncture.layers.front();
    layer.strength = layer.toughness / (M_E * wall.opening * kTip);
    const double unit = M_PI * kTip * kTip * 1e3, begin = now();
    const PiercedBranch branch = solvePiercedBranch(scene, level);
    if (!branch.onset()) throw std::runtime_error(std::string("no onset of cell ") + cell.name);
    char row[200];
    std::snprintf(row, sizeof row, "cohesive,%s,%g,%.4g,%.4f,%.4f,%.4f,%.4f,%.0f\n", cell.name, wall.opening,
                  layer.strength / 1e3, steadyPenetration(scene).hole_radius, branch.onset()->depth / kTip,
                  branch.onset()->force / unit, branch.onset()->pierced_force / unit, now() - begin);
    table.add(row);
  }
}

/// A shell of 2 tip radii over an inside, with and without a tense surface of the latter: onset of both and the force
/// in each against the balance of a long hole in that layer.
void layers(PrintedTable& table, double level) {
  table.add(
      "study,inside_over_shell,tension_over_mu_R,onset_depth_over_R,onset_force,through_depth_over_R,"
      "force_in_shell,force_inside,closed_inside,seconds\n");
  struct Inside {
    double softer, tension;
  };
  for (const auto& [softer, tension] : {Inside{0.5, 0}, {0.1, 0}, {0.1, 0.1}}) {
    Scene scene = sceneOf({"shell", "neo_hookean", 0, 12, 4, 0.5});
    scene.needle.contact.mode = "sticking";
    scene.cell.layers.push_back(scene.cell.layers.front());
    Scene::Layer& inside = scene.cell.layers.back();
    inside.name = "inside";
    inside.outer_radius -= 2 * kTip;
    inside.material.young_modulus *= softer;
    inside.surface_tension = tension * 1e3 * kTip;
    scene.cell.puncture.layers.emplace_back().toughness = softer * scene.cell.puncture.layers.front().toughness;
    const double unit = M_PI * kTip * kTip * 1e3, begin = now();
    const PiercedBranch branch = solvePiercedBranch(scene, level);
    if (!branch.onset()) throw std::runtime_error("a shell without an onset");
    const PiercedBranch::Onset onset = *branch.onset();
    const double border = branch.crack().parts.back().from;
    double depth = onset.depth, length = onset.length, in_shell = onset.pierced_force;
    const auto goOn = [&] {
      length = branch.grown(depth += kTip / 40, length);
      if (depth > 1.5 * scene.radius()) throw std::runtime_error("the hole stays behind the needle");
    };
    for (; length <= border; goOn()) in_shell = branch.at(depth, length).force;
    const double through = depth;
    while (length < border + 3 * kTip) goOn();
    const double hole = steadyPenetration(scene).hole_radius;
    const auto material = makeMaterial(inside.material);
    const HoleExpansion expansion(*material, inside.outer_radius / kTip);
    const double closed = kTip * kTip * expansion.at(hole).energy + branch.crack().parts.back().cost;
    char row[200];
    std::snprintf(row, sizeof row, "layers,%g,%g,%.3f,%.4f,%.3f,%.4f,%.4f,%.4f,%.0f\n", softer, tension,
                  onset.depth / kTip, onset.force / unit, through / kTip, in_shell / unit,
                  branch.at(depth, length).force / unit, closed / unit, now() - begin);
    table.add(row);
  }
}

/// Median, what one of ten exceeds, and the worst of relative errors, in percent.
std::string quantiles(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  char text[100];
  std::snprintf(text, sizeof text, "%.3g,%.3g,%.3g", 100 * errors[errors.size() / 2],
                100 * errors[errors.size() * 9 / 10], 100 * errors.back());
  return text;
}

/// Members of the shipped family that nobody has solved, against their own solutions.
void family(PrintedTable& table, int members) {
  const std::string folder = MICROINJECTION_SOURCE_DIR "/config/families/pierced/";
  const PiercedFamily shipped(SectionFamilyData::loadBoth(folder + "homogeneous.yaml"));
  const SectionFamily& of = shipped.data().family();
  std::mt19937 random(1);
  std::vector<double> whole, pierced, depths, forces, times;
  for (int i = 0; i < members; ++i) {
    Eigen::VectorXd at(of.dimension());
    for (double& x : at) x = 2 * (random() / 4294967296.0) - 1;
    const Scene scene = of.member(at);
    const PiercedBranch solved = solvePiercedBranch(scene);
    const FamilyBranch found = shipped.branch(scene);
    const PiercedBranch& own = found.branch;
    if (!solved.onset() || !own.onset()) throw std::runtime_error("a member is not pierced");
    const PiercedBranch::Onset onset = *solved.onset();
    const double tip = scene.needle.tip.radius;
    for (double depth = tip / 2; depth < onset.depth; depth += tip / 4)
      whole.push_back(std::abs(own.whole(depth).force / solved.whole(depth).force - 1));
    double ours = own.onset()->length, theirs = onset.length;
    const double begin = now();
    int steps = 0;
    for (double depth = onset.depth; depth < onset.depth + 4 * tip; depth += tip / 100, ++steps)
      own.at(depth, ours = own.grown(depth, ours));
    times.push_back((now() - begin) / steps);
    ours = own.onset()->length;
    for (double depth = onset.depth + tip / 4; depth < onset.depth + 4 * tip; depth += tip / 4) {
      const double force = own.at(depth, ours = own.grown(depth, ours)).force;
      pierced.push_back(std::abs(force / solved.at(depth, theirs = solved.grown(depth, theirs)).force - 1));
    }
    depths.push_back(std::abs(own.onset()->depth / onset.depth - 1));
    forces.push_back(std::abs(own.onset()->force / onset.force - 1));
    std::fprintf(stderr, "puncture: member %d of %d\n", i + 1, members);
  }
  std::sort(times.begin(), times.end());
  table.add("study,of,members,median_percent,nine_of_ten_percent,worst_percent\n");
  const std::string count = std::to_string(members) + ",";
  table.add("family,force of the whole cell," + count + quantiles(whole) + "\n");
  table.add("family,force of the pierced cell," + count + quantiles(pierced) + "\n");
  table.add("family,depth of the onset," + count + quantiles(depths) + "\n");
  table.add("family,force of the onset," + count + quantiles(forces) + "\n");
  char row[100];
  std::snprintf(row, sizeof row, "family,microseconds a step,%d,%.3g,,\n", members, 1e6 * times[times.size() / 2]);
  table.add(row);
}

/// The dent in which cell A, with a shear modulus of an oocyte, breaks under the pulses of a piezo.
void piezo(PrintedTable& table, double level) {
  table.add("study,viscosity,amplitude,rise_time,pulse_force,dent,dent_without\n");
  const PiercedBranch branch = solvePiercedBranch(sceneOf(kCells[0], 6e3), level);
  const PiercedBranch::Onset onset = *branch.onset();
  for (const double viscosity : {1e-3, 0.2, 1.0}) {
    for (const double amplitude : {0.5e-6, 2e-6}) {
      for (const double rise_time : {10e-6, 50e-6, 200e-6}) {
        const auto missing = [&](double dent) {
          const double force = branch.whole(dent).force;
          const double stiffness = (branch.whole(dent + amplitude).force - force) / amplitude;
          const StrokeResistance resistance{kTip, viscosity, stiffness};
          return onset.force - force - resistance.largestForce({amplitude, rise_time});
        };
        const double shallow = 1e-3 * kTip;
        double dent = 0;
        if (missing(shallow) > 0) {
          const auto found =
              boost::math::tools::bisect(missing, shallow, onset.depth, boost::math::tools::eps_tolerance<double>(20));
          dent = found.first;
        }
        char row[200];
        std::snprintf(row, sizeof row, "piezo,%g,%g,%g,%.3g,%.3g,%.3g\n", viscosity, amplitude, rise_time,
                      onset.force - branch.whole(dent).force, dent, onset.depth);
        table.add(row);
      }
    }
  }
}

/// The paper's cell under a hemisphere of 3 um that sticks, as in config/cells/mouse_oocyte_pipette.yaml: punctured at
/// 7.5 uN and 45 um (section V.A). One point cannot tell modulus and stiffening apart: for each exponent the modulus is
/// that with this force there, and the toughness that with the onset there.
void paper(PrintedTable& table, double level) {
  constexpr double kForce = 7.5e-6, kDepth = 45e-6;
  constexpr int kTries = 5;
  table.add(
      "study,exponent,young_modulus,toughness,hole_radius,onset_depth,onset_force,pierced_force,force_3_um_on,"
      "steady_force,force_out,seconds\n");
  for (const double exponent : {8.0, 10.0}) {
    Scene scene = sceneOf({"paper", "ogden", exponent, 28e-6 / kTip, 10e-6 / kTip, 1});
    scene.needle.contact.mode = "sticking";
    PiercedCellConfig config;
    config.layers = scene.cell.layers;
    config.held_radius = 10e-6;
    config.tip_radius = kTip;
    config.hole_length = 0;
    config.sticking = true;
    config.level = level;
    PiercedCell whole(config);
    if (!whole.advance(kDepth)) throw std::runtime_error("the whole cell: " + whole.reason());
    scene.cell.material().young_modulus *= kForce / whole.force();
    const DeepPenetration deep(scene.cell.material(), 28e-6 / kTip);
    double share = 0.35, before = 0, depth_before = 0;  // steady force over that of the puncture; of the last try
    for (int i = 0; i < kTries; ++i) {
      const double begin = now();
      scene.cell.puncture.layers.front().toughness = kTip * deep.toughnessFor(share * kForce / (kTip * kTip));
      const SteadyPenetration steady = steadyPenetration(scene);
      const PiercedBranch branch = solvePiercedBranch(scene, level);
      if (!branch.onset()) {  // so tough that its onset is beyond the solved paths
        std::fprintf(stderr, "puncture: exponent %g, %.4g of the force: no onset on the solved paths\n", exponent,
                     share);
        share *= 0.93;
        continue;
      }
      const PiercedBranch::Onset onset = *branch.onset();
      const auto on = [&](double further) {  // N, in steps, because the hole does not become shorter
        double length = onset.length;
        for (double way = 0; way <= further; way += kTip / 12) length = branch.grown(onset.depth + way, length);
        return branch.at(onset.depth + further, length).force;
      };
      char row[300];
      std::snprintf(row, sizeof row, "paper,%g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.0f\n", exponent,
                    scene.cell.material().young_modulus, scene.cell.puncture.layers.front().toughness,
                    steady.hole_radius * kTip, onset.depth, onset.force, onset.pierced_force, on(3e-6),
                    steady.force_in * kTip * kTip, steady.force_out * kTip * kTip, now() - begin);
      table.add(row);
      if (std::abs(onset.depth - kDepth) < 0.002 * kDepth) break;
      // The depth of the onset over the logarithm of the steady force is nearly a straight line; at first its slope
      // is that of the whole cell's force.
      const double last = std::log(share);
      const double slope = before == 0 ? kDepth / 6 : (onset.depth - depth_before) / (last - before);
      before = last;
      depth_before = onset.depth;
      share = std::exp(last + (kDepth - onset.depth) / slope);
    }
  }
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  std::string studies = "steady,branches,cohesive,layers,piezo";
  double level = 0;
  int members = 30;
  namespace po = boost::program_options;
  po::options_description more;
  more.add_options()("studies", po::value(&studies)->default_value(studies),
                     "steady, branches, cohesive, layers, piezo, paper, family");
  more.add_options()("level", po::value(&level)->default_value(level), "of the meshes: each halves the elements");
  more.add_options()("members", po::value(&members)->default_value(members), "of the study family");
  return benchMain(
      argc, argv, "puncture: energy balance of a long hole, onset of the puncture and the force behind it",
      [&] {
        const auto asked = [&](const char* study) { return studies.find(study) != std::string::npos; };
        PrintedTable table;
        if (asked("steady")) steady(table);
        if (asked("branches")) branches(table, level);
        if (asked("cohesive")) cohesive(table, level);
        if (asked("layers")) layers(table, level);
        if (asked("piezo")) piezo(table, level);
        if (asked("paper")) paper(table, level);
        if (asked("family")) family(table, members);
        return table.text();
      },
      more);
}
