#pragma once

#include <array>
#include <atomic>

namespace microinjection {

/// Passes the newest value from one thread to another without blocking either of them. It is a
/// triple buffer: the writer's slot, the reader's slot, and one between that they exchange. The
/// reader misses values that it is too slow for. Does not allocate, unless copying T does.
template <typename T>
class LatestValue {
 public:
  /// Call in the writing thread only.
  void write(const T& value) {
    slots_[writing_].value = value;
    writing_ = between_.exchange(writing_ | kNew, std::memory_order_acq_rel) & kSlot;
  }

  /// Call in the reading thread only. Takes the newest value; returns whether one was written since
  /// the last call.
  bool update() {
    if (!(between_.load(std::memory_order_relaxed) & kNew)) return false;
    reading_ = between_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return true;
  }

  /// Call in the reading thread only. The value that the last update() took; T() before the first.
  const T& value() const { return slots_[reading_].value; }

 private:
  static constexpr unsigned kSlot = 3, kNew = 4;
  struct alignas(64) Slot {  // a cache line of its own, so that the threads do not slow each other down
    T value{};
  };

  std::array<Slot, 3> slots_;
  std::atomic<unsigned> between_{1};  ///< the free slot, and kNew when the writer left a new value in it
  alignas(64) unsigned writing_ = 0;  ///< slot of the writing thread
  alignas(64) unsigned reading_ = 2;  ///< slot of the reading thread
};

}  // namespace microinjection
