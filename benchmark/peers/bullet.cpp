// Bullet's deformable bodies as a program of ./dev bench peers: reads a case, writes a result.

#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark/peers/peer_case.h"
#include "benchmark/peers/peer_result.h"

namespace microinjection {
namespace {

// Single precision has its range about 1: micrometres, micronewtons and megapascals.
constexpr double kLength = 1e6, kForce = 1e6, kStress = 1e-6;
// The inertia m / dt^2 of a node is some 1e-5 of its stiffness: each step ends in equilibrium.
constexpr btScalar kTimeStep = 1, kNodeMass = 1e-6F;

double processTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

btVector3 scaled(const Eigen::Vector3d& point) {
  const Eigen::Vector3f p = (kLength * point).cast<float>();
  return {p.x(), p.y(), p.z()};
}

class Solver : public btDeformableBodySolver {
 public:
  explicit Solver(int newton_iterations) { m_maxNewtonIterations = newton_iterations; }
};

/// A world with one deformable body, without gravity and collisions.
class BulletCell {
 public:
  BulletCell(const PeerCase& peer_case, int newton_iterations)
      : glued_(peer_case.glued),
        dispatcher_(&collision_),
        solver_(newton_iterations),
        world_(&dispatcher_, &broadphase_, &constraint_solver_, &collision_, &solver_) {
    constraint_solver_.setDeformableSolver(&solver_);
    world_.setGravity({0, 0, 0});
    world_.getWorldInfo().m_gravity = {0, 0, 0};
    world_.setImplicit(true);
    world_.setLineSearch(false);
    world_.setUseProjection(true);
    makeBody(peer_case);
    const PeerCase::Layer& layer = peer_case.layers.front();
    const double nu = layer.poisson_ratio, young = kStress * layer.young_modulus;
    const double mu = young / (2 * (1 + nu)), lambda = young * nu / ((1 + nu) * (1 - 2 * nu));
    // Its energy is the stable neo-Hookean, whose constants have to be changed for the same small strains.
    force_ = std::make_unique<btDeformableNeoHookeanForce>(4 * mu / 3, lambda + 5 * mu / 6, 0);
    world_.addForce(body_.get(), force_.get());
  }

  ~BulletCell() {
    world_.removeForce(body_.get(), force_.get());
    world_.removeSoftBody(body_.get());
  }
  BulletCell(const BulletCell&) = delete;
  BulletCell& operator=(const BulletCell&) = delete;

  void step(const Eigen::Vector3d& displacement) {
    for (std::size_t i = 0; i < glued_.size(); ++i) {
      btSoftBody::Node& node = body_->m_nodes[glued_[i]];
      // The solver starts from m_vn, and the projection then keeps it.
      node.m_v = node.m_vn = (rest_[i] + scaled(displacement) - node.m_x) / kTimeStep;
    }
    world_.stepSimulation(kTimeStep, 0);
  }

  /// N, of the body on the tip.
  Eigen::Vector3d tipForce() {
    body_->updateDeformation();
    btAlignedObjectArray<btVector3> forces;
    forces.resize(body_->m_nodes.size(), btVector3(0, 0, 0));
    force_->addScaledElasticForce(1, forces);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : glued_) {
      const btVector3& f = forces[body_->m_nodes[node].index];
      sum += Eigen::Vector3d(f.x(), f.y(), f.z());
    }
    return sum / kForce;
  }

 private:
  void makeBody(const PeerCase& peer_case) {
    std::vector<btVector3> nodes;
    for (const Eigen::Vector3d& node : peer_case.nodes) nodes.push_back(scaled(node));
    const std::vector<btScalar> masses(nodes.size(), kNodeMass);
    body_ = std::make_unique<btSoftBody>(&world_.getWorldInfo(), static_cast<int>(nodes.size()), nodes.data(),
                                         masses.data());
    for (const PeerCase::Element& element : peer_case.elements) {
      body_->appendTetra(element.nodes[0], element.nodes[1], element.nodes[2], element.nodes[3]);
    }
    body_->m_tetraScratches.resize(body_->m_tetras.size());
    body_->m_tetraScratchesTn.resize(body_->m_tetras.size());
    body_->initializeDmInverse();
    body_->m_cfg.collisions = 0;
    body_->setSelfCollision(false);
    body_->setActivationState(DISABLE_DEACTIVATION);
    for (const int node : peer_case.held) body_->setMass(node, 0);
    for (const int node : glued_) {
      body_->setMass(node, 0);
      rest_.push_back(body_->m_nodes[node].m_x);
    }
    world_.addSoftBody(body_.get());
  }

  std::vector<int> glued_;
  std::vector<btVector3> rest_;
  btSoftBodyRigidBodyCollisionConfiguration collision_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableMultiBodyConstraintSolver constraint_solver_;
  Solver solver_;
  btDeformableMultiBodyDynamicsWorld world_;
  std::unique_ptr<btSoftBody> body_;
  std::unique_ptr<btDeformableNeoHookeanForce> force_;
};

/// Empty when Bullet can serve the case.
std::string refusal(const PeerCase& peer_case) {
  if (peer_case.dimension != 3 || peer_case.order != 1) return "linear tetrahedra only";
  if (peer_case.glued.empty()) return "a tip that sticks to nodes only";
  if (peer_case.layers.size() != 1) return "one layer only";
  const std::string& law = peer_case.layers.front().law;
  if (law != "neo_hookean" && law != "stable_neo_hookean") return "neo-Hookean materials only";
  return "";
}

PeerResult solve(int newton_iterations, const PeerCase& peer_case) {
  PeerResult result;
  result.program = "Bullet " + std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
  result.model = newton_iterations == 1 ? "one solution a step" : "equilibrium";
  result.element = "p1";
  result.declined = refusal(peer_case);
  if (!result.declined.empty()) return result;
  result.law = peer_case.layers.front().law == "stable_neo_hookean" ? "same" : "stable_neo_hookean";
  BulletCell cell(peer_case, newton_iterations);
  for (const Eigen::Vector3d& displacement : peer_case.motion) {
    const double start = processTime();
    cell.step(displacement);
    const double time = processTime() - start;
    result.steps.push_back({cell.tipForce(), time});
  }
  return result;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: " << argv[0] << " NEWTON_ITERATIONS CASE RESULT\n";
    return 2;
  }
  try {
    const microinjection::PeerResult result =
        microinjection::solve(std::stoi(argv[1]), microinjection::readPeerCase(argv[2]));
    std::ofstream file(argv[3]);
    file << microinjection::peerResultText(result);
    return file.flush() ? 0 : 2;
  } catch (const std::exception& exception) {
    std::cerr << argv[0] << ": " << exception.what() << '\n';
    return 2;
  }
}
