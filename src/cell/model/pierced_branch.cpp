#include "cell/model/pierced_branch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

constexpr int kLengths = 400;  ///< that are tried for the onset, of the longest hole
constexpr int kDepths = 400;   ///< same, of the whole cell's path
constexpr int kHalvings = 40;

struct Values {
  double energy, force;
};

/// Cubic between two knots by their energies and forces.
Values between(const PiercedBranch::Knot& a, const PiercedBranch::Knot& b, double beyond) {
  const double width = b.beyond - a.beyond, t = (beyond - a.beyond) / width, u = 1 - t;
  const double energy = (1 + 2 * t) * u * u * a.energy + t * u * u * width * a.force + t * t * (3 - 2 * t) * b.energy -
                        t * t * u * width * b.force;
  const double force =
      6 * t * u * (b.energy - a.energy) / width + u * (1 - 3 * t) * a.force + t * (3 * t - 2) * b.force;
  return {energy, force};
}

Values valuesOf(const std::vector<PiercedBranch::Knot>& knots, double beyond) {
  const PiercedBranch::Knot &first = knots.front(), &last = knots.back();
  if (beyond <= first.beyond) return {first.energy + first.force * (beyond - first.beyond), first.force};
  if (beyond >= last.beyond) {
    const PiercedBranch::Knot& before = knots[knots.size() - 2];
    const double stiffness = (last.force - before.force) / (last.beyond - before.beyond), on = beyond - last.beyond;
    return {last.energy + (last.force + 0.5 * stiffness * on) * on, last.force + stiffness * on};
  }
  const auto next = std::upper_bound(knots.begin(), knots.end(), beyond,
                                     [](double value, const PiercedBranch::Knot& knot) { return value < knot.beyond; });
  return between(*(next - 1), *next, beyond);
}

}  // namespace

PiercedBranch::PiercedBranch(std::vector<Knot> whole, std::vector<Hole> holes, Crack crack)
    : whole_(std::move(whole)), holes_(std::move(holes)), crack_(std::move(crack)) {
  const auto rises = [](const std::vector<Knot>& knots) {
    const auto falls = [](const Knot& a, const Knot& b) { return !(a.beyond < b.beyond); };
    return knots.size() >= 2 && std::adjacent_find(knots.begin(), knots.end(), falls) == knots.end();
  };
  bool good = rises(whole_) && holes_.size() >= 2 && holes_.front().length > 0;
  for (std::size_t i = 0; good && i < holes_.size(); ++i)
    good = rises(holes_[i].knots) && (i == 0 || holes_[i].length > holes_[i - 1].length);
  if (!good)
    throw std::invalid_argument("a pierced branch needs two holes or more of rising length, with rising knots");
  const auto& parts = crack_.parts;
  good = crack_.barrier >= 0 && !parts.empty() && parts.front().from == 0;
  for (std::size_t i = 0; good && i < parts.size(); ++i)
    good = parts[i].cost >= 0 && (i == 0 || parts[i].from > parts[i - 1].from);
  if (!good) throw std::invalid_argument("a crack needs costs that are not negative, of parts that begin at 0");
  for (const Hole& hole : holes_) furthest_ = std::max(furthest_, hole.knots.back().beyond);
  onset_ = findOnset();
}

PiercedBranch PiercedBranch::tougher(double factor) const {
  Crack crack = crack_;
  for (Crack::Part& part : crack.parts) part.cost *= factor;
  return {whole_, holes_, std::move(crack)};
}

double PiercedBranch::costAt(double length) const {
  double cost = crack_.parts.front().cost;
  for (const Crack::Part& part : crack_.parts) {
    if (length > part.from) cost = part.cost;
  }
  return cost;
}

double PiercedBranch::costUntil(double length) const {
  double sum = 0;
  for (std::size_t i = 0; i < crack_.parts.size(); ++i) {
    const double end = i + 1 < crack_.parts.size() ? std::min(crack_.parts[i + 1].from, length) : length;
    sum += crack_.parts[i].cost * std::max(end - crack_.parts[i].from, 0.0);
  }
  return sum;
}

PiercedBranch::State PiercedBranch::whole(double depth) const {
  const Values values = valuesOf(whole_, depth);
  return {values.force, values.energy, 0};
}

std::size_t PiercedBranch::rightOf(double length) const {
  std::size_t i = 1;
  while (i + 1 < holes_.size() && holes_[i].length < length) ++i;
  return i;
}

/// A needle that is not as far in its hole is not known to stay there. Further in, energies are continued, and too
/// small where the cell stiffens.
bool PiercedBranch::isSolved(double depth, double length) const {
  const std::size_t right = rightOf(length);
  const std::vector<Knot>&left_knots = holes_[right - 1].knots, &right_knots = holes_[right].knots;
  const double first = std::max(left_knots.front().beyond, right_knots.front().beyond);
  const double last = std::min(left_knots.back().beyond, right_knots.back().beyond);
  return depth - length >= first && depth - length <= last;
}

/// Cubic in the length with slopes of parabolas: linear in the values, so that force and release are derivatives of one
/// energy.
PiercedBranch::State PiercedBranch::at(double depth, double length) const {
  const double inside = std::clamp(length, shortest(), longest()), beyond = depth - length;
  const std::size_t i = rightOf(inside);
  const int count = static_cast<int>(holes_.size()), left = static_cast<int>(i) - 1;
  const auto value = [&](int k) { return valuesOf(holes_[k].knots, beyond); };
  const double width = holes_[left + 1].length - holes_[left].length, t = (inside - holes_[left].length) / width;
  const double u = 1 - t;
  Values v[4] = {{0, 0}, value(left), value(left + 1), {0, 0}};
  const bool has_before = left > 0, has_after = left + 2 < count;
  if (has_before) v[0] = value(left - 1);
  if (has_after) v[3] = value(left + 2);
  const auto slope = [&](int k, const auto& pick) {  // of the k-th of the four
    const double here = holes_[left - 1 + k].length;
    const bool open_left = k == 1 && !has_before, open_right = k == 2 && !has_after;
    if (open_left || open_right) return (pick(v[2]) - pick(v[1])) / width;
    const double back = here - holes_[left - 2 + k].length, on = holes_[left + k].length - here;
    return ((pick(v[k]) - pick(v[k - 1])) / back * on + (pick(v[k + 1]) - pick(v[k])) / on * back) / (back + on);
  };
  const auto energy = [](const Values& x) { return x.energy; };
  const auto force = [](const Values& x) { return x.force; };
  const auto cubic = [&](const auto& pick) {
    return (1 + 2 * t) * u * u * pick(v[1]) + t * u * u * width * slope(1, pick) + t * t * (3 - 2 * t) * pick(v[2]) -
           t * t * u * width * slope(2, pick);
  };
  const auto along = [&](const auto& pick) {  // derivative by the length, at a fixed place beyond
    return 6 * t * u * (pick(v[2]) - pick(v[1])) / width + u * (1 - 3 * t) * slope(1, pick) +
           t * (3 * t - 2) * slope(2, pick);
  };
  State state;
  state.force = cubic(force) + along(force) * (length - inside);
  state.energy = cubic(energy) + along(energy) * (length - inside);
  state.release = state.force - along(energy);
  return state;
}

double PiercedBranch::grown(double depth, double length, const Resistance& resistance) const {
  const auto grows = [&](double at_length) {
    return at(depth, at_length).release > resistance.tougher * costAt(at_length) + resistance.at(at_length);
  };
  // Beyond the paths the crack has long grown: forces there are no solutions.
  const double from = std::max({length, shortest(), depth - furthest_});
  if (!grows(from)) return from;
  const double step = longest() / kLengths;
  double low = from, high = from + step;
  while (grows(high) && high < depth + longest()) {
    low = high;
    high += step;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (grows(middle) ? low : high) = middle;
  }
  return high;
}

std::optional<PiercedBranch::Onset> PiercedBranch::findOnset() const {
  struct Length {
    double length = 0, excess = 0;  // m; J, energy and cost above the whole cell's energy
  };
  const auto best = [&](double depth) {
    Length least{0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i <= kLengths; ++i) {
      const double length = shortest() + (longest() - shortest()) * i / kLengths;
      if (!isSolved(depth, length)) continue;
      const double excess = at(depth, length).energy + costUntil(length) + crack_.barrier - whole(depth).energy;
      if (excess < least.excess) least = {length, excess};
    }
    return least;
  };
  double high = crack_.gives_way;
  if (high == 0) {
    const double first = whole_.front().beyond, last = whole_.back().beyond;
    double low = high = first;
    for (int i = 1; i <= kDepths && best(high).excess >= 0; ++i) {
      low = high;
      high = first + (last - first) * i / kDepths;
    }
    if (best(high).excess >= 0) return std::nullopt;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      (best(middle).excess < 0 ? high : low) = middle;
    }
  }
  if (std::isinf(best(high).excess)) return std::nullopt;
  Onset onset;
  onset.depth = high;
  onset.force = whole(high).force;
  const double step = (longest() - shortest()) / kLengths;
  onset.length = grown(high, std::max(shortest(), best(high).length - step));
  onset.pierced_force = at(high, onset.length).force;
  return onset;
}

}  // namespace microinjection
