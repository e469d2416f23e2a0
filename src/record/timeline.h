#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace microinjection {

/// ns since the clock's zero: exact, so that messages that derive from one another can be joined by their stamps.
using Nanoseconds = std::int64_t;

/// What one source said, in the order of its stamps, whenever it came.
template <typename Value>
class Timeline {
 public:
  struct Entry {
    Nanoseconds stamp = 0;
    std::optional<Value> value;  ///< empty: what was said before does not hold any more
  };

  /// What is older than the newest is not believed; of two with the same stamp the later one holds.
  void put(Nanoseconds stamp, std::optional<Value> value) {
    if (!entries_.empty() && stamp < entries_.back().stamp) return;
    if (!entries_.empty() && stamp == entries_.back().stamp) entries_.pop_back();
    entries_.push_back({stamp, std::move(value)});
  }

  /// The source takes back what it said, as from right after its last stamp.
  void withdraw() {
    if (!entries_.empty() && entries_.back().value) entries_.push_back({entries_.back().stamp + 1, std::nullopt});
  }

  /// The last entry that was said at `time` or before, when it has a value and is not older than `timeout`; else null.
  const Entry* at(Nanoseconds time, Nanoseconds timeout) const {
    const Entry* found = nullptr;
    for (const Entry& entry : entries_) {
      if (entry.stamp > time) break;
      found = &entry;
    }
    return found && found->value && time - found->stamp <= timeout ? found : nullptr;
  }

  /// The first entry with a value for which `is(value)` after `time`; else null.
  template <typename Predicate>
  const Entry* firstAfter(Nanoseconds time, const Predicate& is) const {
    for (const Entry& entry : entries_) {
      if (entry.stamp > time && entry.value && is(*entry.value)) return &entry;
    }
    return nullptr;
  }

  /// Forgets what at(time) and later ones do not need.
  void forgetBefore(Nanoseconds time) {
    while (entries_.size() > 1 && entries_[1].stamp <= time) entries_.pop_front();
  }

 private:
  std::deque<Entry> entries_;
};

}  // namespace microinjection
