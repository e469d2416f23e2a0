#include "cell/mechanics/viscous_stress.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "cell/mechanics/element_sum.h"

namespace microinjection {

template <int Dim>
ViscousStress<Dim>::ViscousStress(std::shared_ptr<const LayeredBody<Dim>> body,
                                  std::vector<ViscoelasticityConfig> layers)
    : body_(std::move(body)), layers_(std::move(layers)) {
  if (layers_.size() != body_->materials().size()) {
    throw std::invalid_argument("viscoelasticity of " + std::to_string(layers_.size()) + " layers for a body of " +
                                std::to_string(body_->materials().size()));
  }
  ConfigErrors errors;
  for (const ViscoelasticityConfig& layer : layers_) layer.check("viscoelasticity: ", errors);
  errors.throwAny();
  const int displacements = body_->withNodes([](auto nodes) { return Dim * decltype(nodes)::value; });
  for (int e = 0; e < body_->elementCount(); ++e) {
    const int layer = body_->mesh().layers[e];
    if (layers_[layer].empty()) continue;
    const std::vector<int>& entries = body_->entries(e);
    elements_.push_back({e, layer, {entries.begin(), entries.begin() + displacements}, {}});
  }
  reset();
}

template <int Dim>
void ViscousStress<Dim>::reset() {
  for (Element& element : elements_) {
    element.memory.assign(body_->pointCount(), ViscoelasticMemory(layers_[element.layer]));
  }
  beginStep(std::numeric_limits<double>::infinity());
}

template <int Dim>
bool ViscousStress<Dim>::beginStep(double duration) {
  std::vector<ViscoelasticStep> steps;
  for (std::size_t i = 0; i < layers_.size(); ++i) steps.emplace_back(*body_->materials()[i], layers_[i], duration);
  steps_.swap(steps);
  relaxed_ = std::isinf(duration);
  return !relaxed_;
}

template <int Dim>
void ViscousStress<Dim>::accept(const Eigen::VectorXd& state) {
  for (Element& element : elements_) {
    const Material& material = *body_->materials()[element.layer];
    for (int q = 0; q < body_->pointCount(); ++q) {
      const Eigen::Matrix3d F = body_->deformationGradient(element.index, q, state);
      steps_[element.layer].accept(material.kinematics(F), element.memory[q]);
    }
  }
}

template <int Dim>
bool ViscousStress<Dim>::evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  result.zero = relaxed_;
  result.energy = 0;
  if (relaxed_) return true;
  return body_->withNodes(
      [&](auto nodes) { return evaluateNodes<decltype(nodes)::value>(elements_[element], state, order, result); });
}

template <int Dim>
template <int N>
bool ViscousStress<Dim>::evaluateNodes(const Element& element, const Eigen::VectorXd& state, Order order,
                                       LocalEnergy& result) const {
  const Material& material = *body_->materials()[element.layer];
  const ViscoelasticStep& step = steps_[element.layer];
  ElementSum<Dim, N> sum(material, order, result);
  for (int q = 0; q < body_->pointCount(); ++q) {
    const ViscoelasticMemory& memory = element.memory[q];
    const Eigen::Matrix3d F = body_->deformationGradient(element.index, q, state);
    if (material.resistsInversion() && !(F.determinant() > 0)) return false;
    const Material::Kinematics at = material.kinematics(F);
    sum.add([&] { return step.energy(memory, at); }, [&] { return step.stress(memory, at); },
            [&] { return step.tangent(memory, at); }, body_->template derivatives<N>(element.index, q),
            body_->weight(element.index, q));
  }
  sum.finish(N * Dim);
  return std::isfinite(result.energy);
}

template class ViscousStress<2>;
template class ViscousStress<3>;

}  // namespace microinjection
