#include "cell/mechanics/explicit_step.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "cell/mechanics/largest_frequency.h"

namespace microinjection {
namespace {

constexpr double kApproach = 0.05;  // share of the distance to the undeformed body, in each step

void checkVertices(const std::vector<int>& vertices, const std::string& name, std::vector<int>& uses,
                   std::vector<std::string>& errors) {
  for (int vertex : vertices) {
    if (vertex < 0 || vertex >= static_cast<int>(uses.size())) {
      errors.push_back(name + ": vertex " + std::to_string(vertex) + " must be in [0, " + std::to_string(uses.size()) +
                       ")");
    } else if (++uses[vertex] > 1) {
      errors.push_back(name + ": vertex " + std::to_string(vertex) + " must be in held or tip, and once");
    }
  }
}

/// kg, of each vertex.
std::vector<double> lumpedMasses(const TetMesh& mesh, double density) {
  std::vector<double> masses(mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double share = density * tetrahedronVolume(mesh, static_cast<int>(t)) / 4;
    for (int vertex : mesh.tetrahedra[t]) masses[vertex] += share;
  }
  return masses;
}

}  // namespace

void ExplicitStepConfig::validate(std::size_t vertices) const {
  std::vector<std::string> errors;
  if (!(density > 0)) errors.push_back("density = " + std::to_string(density) + " kg/m^3: must be > 0");
  if (!(damping >= 0)) errors.push_back("damping = " + std::to_string(damping) + " 1/s: must be >= 0");
  if (time_step && !(*time_step > 0)) {
    errors.push_back("time_step = " + std::to_string(*time_step) + " s: must be > 0");
  }
  if (!(safety > 0 && safety <= 1)) errors.push_back("safety = " + std::to_string(safety) + ": must be in (0, 1]");
  std::vector<int> uses(vertices, 0);
  checkVertices(held, "held", uses, errors);
  checkVertices(tip, "tip", uses, errors);
  if (!errors.empty()) throw ConfigError(errors);
}

ExplicitStep::ExplicitStep(const TetMesh& mesh, const ExplicitStepConfig& config)
    : tetrahedra_(mesh.tetrahedra), config_(config) {
  using Force = ExplicitStepConfig::Force;
  using Kind = TensorMassForce::Kind;
  config.validate(mesh.vertices.size());
  if (config.force == Force::kKernel) {
    kernel_.emplace(mesh, config.lame);
  } else {
    tensors_.emplace(mesh, config.lame, config.force == Force::kTensors ? Kind::kStVenantKirchhoff : Kind::kLinear);
  }
  for (const Eigen::Vector3d& vertex : mesh.vertices) rest_.insert(rest_.end(), vertex.data(), vertex.data() + 3);
  positions_ = rest_;
  velocities_.assign(rest_.size(), 0);
  forces_.assign(rest_.size(), 0);
  displacements_.assign(rest_.size(), 0);
  masses_ = lumpedMasses(mesh, config.density);
  for (std::size_t v = 0; v < masses_.size(); ++v) {
    if (!(masses_[v] > 0)) throw std::invalid_argument("vertex " + std::to_string(v) + " is of no tetrahedron");
    inverse_masses_.insert(inverse_masses_.end(), 3, 1 / masses_[v]);
  }
  for (int vertex : config_.held) std::fill_n(inverse_masses_.begin() + 3 * vertex, 3, 0.0);
  holdTip();
  if (config.time_step) {
    time_step_ = *config.time_step;
    return;
  }
  highest_frequency_ = findHighestFrequency();
  time_step_ = highest_frequency_ > 0 ? config.safety * 2 / highest_frequency_ : 0;
}

void ExplicitStep::setTip(const std::vector<int>& vertices) {
  ExplicitStepConfig changed = config_;
  changed.tip = vertices;
  changed.validate(masses_.size());
  for (int vertex : config_.tip) std::fill_n(inverse_masses_.begin() + 3 * vertex, 3, 1 / masses_[vertex]);
  config_ = changed;
  holdTip();
}

void ExplicitStep::holdTip() {
  tip_start_.clear();
  for (int vertex : config_.tip) {
    tip_start_.emplace_back(Eigen::Vector3d::Map(&positions_[3 * vertex]));
    std::fill_n(inverse_masses_.begin() + 3 * vertex, 3, 0.0);
    std::fill_n(velocities_.begin() + 3 * vertex, 3, 0.0);
  }
}

void ExplicitStep::reset() {
  positions_ = rest_;
  std::fill(velocities_.begin(), velocities_.end(), 0.0);
  force_.setZero();
  holdTip();
}

/// Applies K by central differences of the force. `safety` covers the error that remains when the
/// power iteration stops.
double ExplicitStep::findHighestFrequency() {
  constexpr PowerIteration kIteration = {1e-6, 300};
  constexpr double kAmplitude = 1e-6;  ///< of the body's size
  const auto count = static_cast<Eigen::Index>(rest_.size());
  const Eigen::Map<const Eigen::VectorXd> rest(rest_.data(), count), inverse_masses(inverse_masses_.data(), count);
  const double amplitude = kAmplitude * rest.norm() / std::sqrt(static_cast<double>(count));
  std::vector<double> moved(rest_.size()), behind(rest_.size());
  Eigen::Map<Eigen::VectorXd> there(moved.data(), count), back(behind.data(), count), ahead(forces_.data(), count);
  const auto map = [&](const Eigen::VectorXd& mode) -> Eigen::VectorXd {
    there = rest + amplitude * mode;
    evaluate(moved, forces_);
    there = rest - amplitude * mode;
    evaluate(moved, behind);
    return inverse_masses.cwiseProduct(back - ahead) / (2 * amplitude);
  };
  Eigen::VectorXd start(count);
  for (Eigen::Index i = 0; i < count; ++i) start[i] = inverse_masses[i] > 0 ? std::cos(7.0 * i * i + i) : 0;
  return std::sqrt(largestEigenvalue(map, start, kIteration));
}

void ExplicitStep::evaluate(const std::vector<double>& positions, std::vector<double>& forces) {
  if (kernel_) return kernel_->evaluate(positions.data(), forces.data());
  for (std::size_t i = 0; i < rest_.size(); ++i) displacements_[i] = positions[i] - rest_[i];
  tensors_->evaluate(displacements_.data(), forces.data());
}

void ExplicitStep::step(const Eigen::Vector3d& tip_displacement) {
  evaluate(positions_, forces_);
  const double drag = config_.damping * time_step_ / 2, keep = (1 - drag) / (1 + drag), gain = time_step_ / (1 + drag);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    velocities_[i] = keep * velocities_[i] + gain * inverse_masses_[i] * forces_[i];
    positions_[i] += time_step_ * velocities_[i];
  }
  force_.setZero();
  for (std::size_t i = 0; i < config_.tip.size(); ++i) {
    const int entry = 3 * config_.tip[i];
    force_ += Eigen::Vector3d::Map(&forces_[entry]);
    tip_start_[i] += kApproach * (Eigen::Vector3d::Map(&rest_[entry]) - tip_start_[i]);
    Eigen::Vector3d::Map(&positions_[entry]) = tip_start_[i] + tip_displacement;
  }
}

bool ExplicitStep::hasInvertedElement() const {
  return std::any_of(tetrahedra_.begin(), tetrahedra_.end(), [this](const std::array<int, 4>& corners) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
      edges.col(k) =
          Eigen::Vector3d::Map(&positions_[3 * corners[k + 1]]) - Eigen::Vector3d::Map(&positions_[3 * corners[0]]);
    }
    return !(edges.determinant() > 0);
  });
}

double ExplicitStep::kineticEnergy() const {
  double sum = 0;
  for (std::size_t i = 0; i < velocities_.size(); ++i) {
    if (inverse_masses_[i] > 0) sum += velocities_[i] * velocities_[i] / inverse_masses_[i];
  }
  return sum / 2;
}

}  // namespace microinjection
