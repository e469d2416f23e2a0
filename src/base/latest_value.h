#pragma once

#include <array>
#include <atomic>

namespace microinjection {

/// Hands the newest value from one thread to one other: neither ever waits, whatever the scheduler does to the other
/// (a triple buffer: the writer's slot, the reader's slot, and the one between that they exchange). Values in between
/// that the reader was too slow for are lost. Allocates nothing, unless copying T does.
template <typename T>
class LatestValue {
 public:
  /// In the writing thread.
  void write(const T& value) {
    slots_[writing_].value = value;
    writing_ = between_.exchange(writing_ | kNew, std::memory_order_acq_rel) & kSlot;
  }

  /// In the reading thread: takes the newest value over; returns whether one was written since the last call.
  bool update() {
    if (!(between_.load(std::memory_order_relaxed) & kNew)) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return true;
  }

  /// In the reading thread: what the last update() took over; before the first, T().
  const T& value() const { return slots_[reading_].value; }

 private:
  static constexpr unsigned kSlot = 3, kNew = 4;
  struct alignas(64) Slot {  // a cache line of its own, so that the threads do not slow each other down
    T value{};
  };

  std::array<Slot, 3> slots_;
  std::atomic<unsigned> between_{1};  ///< slot that nobody uses, and whether the writer left something new in it
  alignas(64) unsigned writing_ = 0;  ///< slot, of the writing thread
  alignas(64) unsigned reading_ = 2;  ///< slot, of the reading thread
};

}  // namespace microinjection
