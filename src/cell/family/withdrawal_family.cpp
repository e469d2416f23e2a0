#include "cell/family/withdrawal_family.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/family/family_file.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/model/similarity.h"

namespace microinjection {
namespace {

using Turn = WithdrawalLoss::Turn;

// Over the cell's radius.
const std::vector<double> kTurnDepths = {0.02, 0.05, 0.1, 0.2, 0.35, 0.5};
constexpr double kLeastFall = 1e-3;
constexpr std::size_t kFewestTurns = 4;  ///< beyond the last with a solution its shares stay

constexpr double kMeshOfWays = 0.5;              ///< level of scene_mesh.h
constexpr int kWayIn = 32, kMostBeyond = 90;     ///< steps
constexpr double kBeyond = 0.25, kWider = 1.08;  ///< of adhesion's range: the first step above first contact; the next

// Columns of a member: log(1 + share) of the deepest turn and of a shallow one, for the errors; then of each turn; then
// a column with four rows for each turn: where adhesion pulls most, the logarithms of over what that falls, of the
// largest pull over pullUnit(), and of the force at the turn.
constexpr int kDeepTold = 0, kShallowTold = 1, kFirstTurn = 2;
enum Row { kPullDepth, kFall, kPull, kForce, kRowsOfTurn };
constexpr std::size_t kShallow = 1;

constexpr double kFading = 4;  ///< power of a correction's way from the largest pull to the turn

/// A member without adhesion is solved with this energy, over the tip's radius, which no force tells from none: so that
/// its pull over the energy is known.
constexpr double kWeakAdhesion = 1e-5;

/// A scene without dimension. Between 3/2 (JKR) and 2 (DMT) times this is the pull-off of spheres.
double pullUnit(const Scene& scene) {
  return M_PI * scene.needle.contact.adhesion_energy / (1 + 1 / scene.needle.tip.radius);
}

Scene adheringAtAll(Scene scene) {
  double& energy = scene.needle.contact.adhesion_energy;
  energy = std::max(energy, kWeakAdhesion * scene.needle.tip.radius);
  return scene;
}

int columnsOfWithdrawal() { return kFirstTurn + static_cast<int>(kTurnDepths.size()) + 1; }

class WaysOfMember {
 public:
  explicit WaysOfMember(const Scene& scene)
      : range_(scene.needle.contact.adhesion_range),
        problem_(scene, makeSceneMesh<2>(scene, kMeshOfWays), ElementKind::kP2P0) {}

  struct Way {
    Turn turn;
    double pull = 0, force = 0;  ///< the largest one; at the turn
  };
  /// Nothing where a way has no solution: reason() says why.
  std::optional<Way> from(double deepest) {
    problem_.reset();
    depths_.clear();
    losses_.clear();
    std::vector<double> forces;
    for (int i = 0; i <= 2 * kWayIn; ++i) {
      const int place = std::min(i, 2 * kWayIn - i);
      const double depth = deepest * std::pow(place / double{kWayIn}, 2);
      const IndentationSolution solution = problem_.solve({0, 0, -depth});
      reason_ = solution.reason;
      if (!solution.converged) return std::nullopt;
      if (i <= kWayIn) forces.push_back(solution.force.z());
      if (i >= kWayIn) add(depth, forces[place] - solution.force.z());
    }
    Way way;
    way.turn.depth = deepest;
    way.force = forces.back();
    way.pull = pullOff(way.turn);
    way.turn.shares.resize(WithdrawalLoss::kKnots);
    for (int i = 0; i < WithdrawalLoss::kKnots; ++i) {
      const double loss = lossAt(WithdrawalLoss::depthOf(i, deepest, way.turn.pull_depth));
      way.turn.shares[i] = std::max(loss, 0.0) / way.force;
    }
    return way;
  }
  const std::string& reason() const { return reason_; }

 private:
  void add(double depth, double loss) {
    depths_.push_back(depth);
    losses_.push_back(loss);
  }

  /// On, above first contact, until a quarter of the largest pull is left. A cell that snaps off has no solution there.
  double pullOff(Turn& turn) {
    double depth = 0, step = kBeyond * range_, largest = losses_.back();
    const std::size_t first = losses_.size() - 1;
    for (int i = 0; i < kMostBeyond && losses_.back() > 0.25 * largest; ++i, step *= kWider) {
      const IndentationSolution solution = problem_.solve({0, 0, -(depth - step)});
      depth -= step;
      add(depth, solution.converged ? -solution.force.z() : 0);
      largest = std::max(largest, losses_.back());
    }
    const auto peak = std::max_element(losses_.begin() + static_cast<std::ptrdiff_t>(first), losses_.end());
    const auto at = static_cast<std::size_t>(peak - losses_.begin());
    turn.pull_depth = at > first && at + 1 < losses_.size() ? -vertex(at) : -depths_[at];
    std::size_t half = at;
    while (half + 1 < losses_.size() && losses_[half] > 0.5 * *peak) ++half;
    const double part = (losses_[half - 1] - 0.5 * *peak) / (losses_[half - 1] - losses_[half]);
    const double fallen = depths_[half - 1] + part * (depths_[half] - depths_[half - 1]);
    turn.fall = std::max(-fallen - turn.pull_depth, kLeastFall);
    return *peak;
  }

  /// Depth at the largest of the parabola through what was solved at `i` and beside it.
  double vertex(std::size_t i) const {
    const double below = depths_[i - 1] - depths_[i], above = depths_[i + 1] - depths_[i];
    const double slope_below = (losses_[i - 1] - losses_[i]) / below,
                 slope_above = (losses_[i + 1] - losses_[i]) / above;
    const double bend = (slope_below - slope_above) / (below - above);
    return depths_[i] - (slope_below - bend * below) / (2 * bend);
  }

  /// Between what was solved.
  double lossAt(double depth) const {
    std::size_t i = 1;
    while (i + 1 < depths_.size() && depths_[i] > depth) ++i;
    const double part = (depth - depths_[i - 1]) / (depths_[i] - depths_[i - 1]);
    return losses_[i - 1] + std::clamp(part, 0.0, 1.0) * (losses_[i] - losses_[i - 1]);
  }

  double range_;
  CellProblem<2> problem_;
  std::vector<double> depths_, losses_;  ///< of the way out, descending
  std::string reason_;
};

}  // namespace

SectionMember solveWithdrawal(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  const Scene scene = adheringAtAll(family.member(coordinates));
  WaysOfMember ways(scene);
  SectionMember member{coordinates, Eigen::MatrixXd::Zero(WithdrawalLoss::kKnots, columnsOfWithdrawal())};
  const Eigen::Index places = member.curves.cols() - 1;
  std::optional<WaysOfMember::Way> way;
  bool ended = false;
  for (std::size_t k = 0; k < kTurnDepths.size(); ++k) {
    std::optional<WaysOfMember::Way> solved = ended ? std::nullopt : ways.from(kTurnDepths[k]);
    ended = !solved;
    if (ended && k < kFewestTurns) throw std::runtime_error("a way has no solution: " + ways.reason());
    if (!ended) way = std::move(solved);
    const auto at = static_cast<Eigen::Index>(k);
    member.curves.col(kFirstTurn + at) = way->turn.shares.array().log1p();
    auto rows = member.curves.col(places).segment<kRowsOfTurn>(kRowsOfTurn * at);
    rows[kPullDepth] = way->turn.pull_depth;
    rows[kFall] = std::log(way->turn.fall);
    rows[kPull] = std::log(way->pull / pullUnit(scene));
    rows[kForce] = std::log(way->force);
  }
  member.curves.col(kDeepTold) = member.curves.col(places - 1);
  member.curves.col(kShallowTold) = member.curves.col(kFirstTurn + static_cast<Eigen::Index>(kShallow));
  if (!member.curves.allFinite()) throw std::runtime_error("a force is not positive");
  return member;
}

WithdrawalFamily::WithdrawalFamily(SectionFamilyData data) : data_(std::move(data)) {
  if (data_.family().kind() != SectionFamily::Kind::kWithdrawal)
    throw std::invalid_argument("family " + data_.family().name() + " has no ways out");
  for (const SectionMember& member : data_.members()) {
    if (member.curves.rows() != WithdrawalLoss::kKnots || member.curves.cols() != columnsOfWithdrawal())
      throw ConfigError("family " + data_.family().name() + ": its data have other curves than ways out");
  }
}

/// The pull is known as a factor of nearly the same size, more exactly than as a share: the shares above follow it.
WithdrawalLoss WithdrawalFamily::loss(const Scene& scene) const {
  const SectionFamilyData::Prediction found = data_.predict(data_.coordinatesOf(scene));
  const Eigen::Index places = found.curves.cols() - 1;
  const double unit = pullUnit(withoutDimension(scene));
  std::vector<Turn> turns;
  for (std::size_t k = 0; k < kTurnDepths.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const auto rows = found.curves.col(places).segment<kRowsOfTurn>(kRowsOfTurn * at);
    Turn turn{scene.radius() * kTurnDepths[k], scene.radius() * std::max(rows[kPullDepth], 0.0),
              scene.radius() * std::exp(rows[kFall]), std::exp(rows[kForce]),
              found.curves.col(kFirstTurn + at).array().exp() - 1};
    const double missing = unit * std::exp(rows[kPull] - rows[kForce]) - turn.shares[0];
    for (int i = 0; i < WithdrawalLoss::kKnots; ++i)
      turn.shares[i] += missing * std::pow(1 - i / (WithdrawalLoss::kKnots - 1.0), kFading);
    turns.push_back(std::move(turn));
  }
  return {turns, found.error.maxCoeff()};
}

std::optional<WithdrawalLoss> findWithdrawal(const std::string& families, const Scene& scene, std::string& reason) {
  return firstFamilyWith(families, "withdrawal", reason, [&](const std::string& file) {
    return WithdrawalFamily(SectionFamilyData::loadBoth(file)).loss(scene);
  });
}

}  // namespace microinjection
