#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace microinjection {

/// ns since the clock's zero: exact, so that messages that derive from one another can be joined by their stamps.
using Nanoseconds = std::int64_t;

/// What one source said, in the order of its stamps, whenever it came. A wrong stamp costs its own message only.
template <typename Value>
class Timeline {
 public:
  struct Entry {
    Nanoseconds stamp = 0;
    std::optional<Value> value;  ///< empty: what was said before does not hold any more
  };

  /// Entries at the most, half a minute of a source at 1 kHz. Beyond that the newest stamps are dropped, so that a
  /// source whose stamps are all ahead of the time cannot fill the memory.
  static constexpr std::size_t kCapacity = 32768;

  /// Inserts the value at its stamp. Of two with the same stamp the later one holds. A stamp before the oldest entry is
  /// ignored once something was forgotten.
  void put(Nanoseconds stamp, std::optional<Value> value) {
    const bool holds = value.has_value();
    if (insert(stamp, std::move(value))) removable_ = holds ? std::optional(stamp) : std::nullopt;
  }

  /// The source takes back what it said, as from right after the last stamp that arrived.
  void withdraw() {
    if (removable_ && *removable_ < std::numeric_limits<Nanoseconds>::max()) insert(*removable_ + 1, std::nullopt);
    removable_.reset();
  }

  /// The last entry that was said at `time` or before, when it has a value and is not older than `timeout`; else null.
  const Entry* at(Nanoseconds time, Nanoseconds timeout) const {
    const auto after = firstStampAfter(time);
    if (after == entries_.begin()) return nullptr;
    const Entry& found = *std::prev(after);
    return found.value && time - found.stamp <= timeout ? &found : nullptr;
  }

  /// The first entry with a value for which `is(value)` after `time`; else null.
  template <typename Predicate>
  const Entry* firstAfter(Nanoseconds time, const Predicate& is) const {
    for (auto entry = firstStampAfter(time); entry != entries_.end(); ++entry) {
      if (entry->value && is(*entry->value)) return &*entry;
    }
    return nullptr;
  }

  /// Forgets what at(time) and later ones do not need.
  void discardBefore(Nanoseconds time) {
    for (; entries_.size() > 1 && entries_[1].stamp <= time; entries_.pop_front()) forgot_ = true;
  }

  std::size_t size() const { return entries_.size(); }

 private:
  using Place = typename std::deque<Entry>::const_iterator;

  Place firstStampAfter(Nanoseconds time) const {
    return std::upper_bound(entries_.begin(), entries_.end(), time,
                            [](Nanoseconds wanted, const Entry& entry) { return wanted < entry.stamp; });
  }

  /// False: it is older than what is known.
  bool insert(Nanoseconds stamp, std::optional<Value> value) {
    const Place after = firstStampAfter(stamp);
    const auto index = after - entries_.cbegin();
    if (index == 0 && forgot_) return false;
    if (index > 0 && entries_[index - 1].stamp == stamp) {
      entries_[index - 1].value = std::move(value);
      return true;
    }
    entries_.insert(after, {stamp, std::move(value)});
    if (entries_.size() > kCapacity) entries_.pop_back();
    return true;
  }

  std::deque<Entry> entries_;
  bool forgot_ = false;                   ///< the oldest entry is not the first that there was
  std::optional<Nanoseconds> removable_;  ///< stamp that arrived last, where its value holds
};

}  // namespace microinjection
