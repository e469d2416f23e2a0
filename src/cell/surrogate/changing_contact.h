#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>

#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {

/// A needle's contact with a surrogate cell that may be replaced at any time, also in contact. The
/// force then changes from the one cell's to the other's in kDuration. A contact keeps its place:
/// the surface of a cell of another size is where the needle has felt it, until the needle is clear
/// of both.
///
/// step() and what it returns belong to one thread, which neither allocates, releases nor locks.
class ChangingContact {
 public:
  static constexpr double kDuration = 0.02;  ///< s

  explicit ChangingContact(std::unique_ptr<SurrogateContact> first);
  ~ChangingContact();
  ChangingContact(const ChangingContact&) = delete;
  ChangingContact& operator=(const ChangingContact&) = delete;

  /// Replaces the cell at the next step, or after the replacement that is going on. A later call
  /// replaces one that was not begun. Call it in one ordinary thread at a time.
  void change(std::unique_ptr<SurrogateContact> next);

  struct Result : SurrogateContact::Result {
    double energy = 0;      ///< J, stored in the cell
    bool changing = false;  ///< the cell is being replaced
  };
  /// `duration`: s, since the last step.
  Result step(const Eigen::Vector3d& tip, double duration);
  void reset();

  /// The cell whose share is larger.
  const SurrogateContact& felt() const { return next_ && share_ > 0.5 ? next_->contact : current_->contact; }

 private:
  struct Node {
    SurrogateContact contact;
    Node* below = nullptr;  ///< in the stack of retired ones
  };
  void begin();
  void retire(Node* node);
  void collect();

  std::unique_ptr<Node> current_, next_;
  double share_ = 0;  ///< of next_
  std::atomic<Node*> incoming_{nullptr};
  std::atomic<Node*> retired_{nullptr};  ///< the thread that steps may not release memory
};

}  // namespace microinjection
