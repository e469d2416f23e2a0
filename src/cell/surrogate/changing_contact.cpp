#include "cell/surrogate/changing_contact.h"

#include <algorithm>
#include <utility>

namespace microinjection {

ChangingContact::ChangingContact(std::unique_ptr<SurrogateContact> first)
    : current_(std::make_unique<Node>(Node{std::move(*first), nullptr})) {}

ChangingContact::~ChangingContact() {
  delete incoming_.exchange(nullptr);
  collect();
}

void ChangingContact::change(std::unique_ptr<SurrogateContact> next) {
  delete incoming_.exchange(new Node{std::move(*next), nullptr}, std::memory_order_acq_rel);
  collect();
}

void ChangingContact::collect() {
  Node* node = retired_.exchange(nullptr, std::memory_order_acquire);
  while (node != nullptr) delete std::exchange(node, node->below);
}

void ChangingContact::retire(Node* node) {
  node->below = retired_.load(std::memory_order_relaxed);
  while (!retired_.compare_exchange_weak(node->below, node, std::memory_order_release, std::memory_order_relaxed)) {
  }
}

void ChangingContact::begin() {
  if (next_ || incoming_.load(std::memory_order_relaxed) == nullptr) return;
  next_.reset(incoming_.exchange(nullptr, std::memory_order_acquire));
  next_->contact.continueFrom(current_->contact);
  share_ = 0;
}

ChangingContact::Result ChangingContact::step(const Eigen::Vector3d& tip, double duration) {
  begin();
  Result result{current_->contact.step(tip)};
  result.energy = current_->contact.energy();
  if (!next_) return result;
  const SurrogateContact::Result after = next_->contact.step(tip);
  const bool touched = current_->contact.contactFrame() || next_->contact.contactFrame();
  share_ = touched ? std::min(1.0, share_ + duration / kDuration) : 1;
  result.changing = true;
  result.force += share_ * (after.force - result.force);
  result.stiffness += share_ * (after.stiffness - result.stiffness);
  result.energy += share_ * (next_->contact.energy() - result.energy);
  result.prepared = result.prepared && after.prepared;
  result.too_deep = result.too_deep || after.too_deep;
  if (share_ == 1) {
    retire(current_.release());
    current_ = std::move(next_);
  }
  return result;
}

void ChangingContact::reset() {
  current_->contact.reset();
  if (next_) next_->contact.reset();
}

}  // namespace microinjection
