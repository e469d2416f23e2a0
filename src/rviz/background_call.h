#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "nodes/bus/bus.h"

namespace microinjection {

/// A call of a service that may wait, in a thread of its own: the stop button lives in the caller's. The thread may
/// outlive this object, and has its share of the bus. On virtual time nothing waits, and there is no thread.
template <typename Answer>
class BackgroundCall {
 public:
  bool running() const { return state_ != nullptr; }
  void start(const std::shared_ptr<Bus>& bus, std::function<Answer(Bus&)> call) {
    state_ = std::make_shared<State>();
    auto task = [state = state_, bus, call = std::move(call)] {
      state->answer = call(*bus);
      state->done = true;
    };
    if (bus->isVirtual()) return task();
    std::thread(std::move(task)).detach();
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
