#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace microinjection {

/// A call of a service that may wait, in a thread of its own: the stop button lives in the caller's. The thread may
/// outlive this object.
template <typename Answer>
class BackgroundCall {
 public:
  bool running() const { return state_ != nullptr; }
  void start(std::function<Answer()> call) {
    state_ = std::make_shared<State>();
    std::thread([state = state_, call = std::move(call)] {
      state->answer = call();
      state->done = true;
    }).detach();
  }
  /// The answer, once.
  std::optional<Answer> take() {
    if (!state_ || !state_->done) return std::nullopt;
    return std::move(std::exchange(state_, nullptr)->answer);
  }

 private:
  struct State {
    std::atomic<bool> done{false};
    Answer answer{};
  };
  std::shared_ptr<State> state_;  ///< of the call under way
};

}  // namespace microinjection
