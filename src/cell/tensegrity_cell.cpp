#include "cell/tensegrity_cell.h"

#include "base/cpu_time.h"
#include "base/errors.h"
#include "tensegrity/tensegrity_loading.h"

namespace microinjection {
namespace {

const TensegrityConfig& validated(const Scene& scene) {
  scene.validate();
  if (!scene.cell.tensegrity) throw ConfigError("cell/model: must be tensegrity");
  return *scene.cell.tensegrity;
}

std::vector<CellUnderNeedle::Member> members(const TensegrityStructure& structure, const Cables& cables,
                                             const Eigen::VectorXd& state) {
  using Member = CellUnderNeedle::Member;
  constexpr std::size_t kEvery = 4;  // sections between the points of a strut's line
  std::vector<Member> result;
  for (int strut = 0; strut < 6; ++strut) {
    const std::vector<Eigen::Vector3d> line = structure.strutLine(strut, state);
    const double force = structure.strutForce(strut, state);
    for (std::size_t from = 0; from + 1 < line.size();) {
      const std::size_t to = std::min(from + kEvery, line.size() - 1);
      result.push_back({Member::Kind::kStrut, line[from], line[to], force});
      from = to;
    }
  }
  for (int i = 0; i < cables.elementCount(); ++i) {
    const Cables::Cable& cable = cables.cable(i);
    const bool actin = structure.isActin(i);
    result.push_back({actin ? Member::Kind::kActin : Member::Kind::kIntermediate, structure.position(cable.a, state),
                      structure.position(cable.b, state), cables.tension(i, state)});
  }
  return result;
}

class TensegrityIndentation : public LiveIndentation {
 public:
  TensegrityIndentation(std::shared_ptr<const TensegrityStructure> structure, const TipPatch& patch)
      : loading_(std::move(structure), patch.vertices) {}

  IndentationSolution solve(const Eigen::Vector3d& tip_displacement, double duration) override {
    const double start = threadCpuTime();
    const LoadPath::Result result = loading_.advance(tip_displacement, duration);
    IndentationSolution solution;
    solution.converged = result.converged;
    solution.reason = result.reason;
    solution.tip_displacement = loading_.displacement();
    solution.force = loading_.force();
    solution.stiffness = loading_.stiffness();
    solution.smallest_jacobian = loading_.structure().struts().smallestJacobian(loading_.state());
    solution.newton_iterations = result.newton_iterations;
    solution.cpu_time = threadCpuTime() - start;
    return solution;
  }
  Eigen::VectorXd displacement() const override {
    const Eigen::VectorXd& start = loading_.structure().start();
    return (loading_.state() - start).head(start.size() - 3);
  }
  std::vector<CellUnderNeedle::Member> members() const override {
    return microinjection::members(loading_.structure(), loading_.cables(), loading_.state());
  }
  Eigen::Vector3d tipDisplacement() const override { return loading_.displacement(); }
  void reset() override { loading_.reset(); }

 private:
  TensegrityLoading loading_;
};

}  // namespace

TensegrityCell::TensegrityCell(const Scene& scene)
    : LiveCell(scene), structure_(std::make_shared<const TensegrityStructure>(validated(scene))) {
  surface_ = structure_->surface();
  held_vertices_ = structure_->heldNodes();
}

std::unique_ptr<LiveIndentation> TensegrityCell::indentation(const TipPatch& patch) const {
  return std::make_unique<TensegrityIndentation>(structure_, patch);
}

std::vector<CellUnderNeedle::Member> TensegrityCell::membersAtRest() const {
  return members(*structure_, *structure_->makeParts().cables, structure_->start());
}

}  // namespace microinjection
