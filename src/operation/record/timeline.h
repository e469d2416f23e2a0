#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

namespace microinjection {

/// ns since the clock's zero. Exact, so that messages with the same stamp can be joined.
using Nanoseconds = std::int64_t;

/// The values of one source in the order of their stamps, whatever the order of arrival. A wrong
/// stamp affects only its own message.
template <typename Value>
class Timeline {
 public:
  struct Entry {
    Nanoseconds stamp = 0;
    std::optional<Value> value;  ///< empty: the earlier value is withdrawn
  };

  /// Largest number of entries, half a minute of a source at 1 kHz. Beyond it the newest stamps are
  /// dropped, so that a source with stamps in the future cannot fill the memory.
  static constexpr std::size_t kCapacity = 32768;

  /// Inserts the value at its stamp. A later value with the same stamp replaces the earlier one. A
  /// stamp before the oldest entry is ignored once entries were discarded.
  void put(Nanoseconds stamp, std::optional<Value> value) {
    const bool holds = value.has_value();
    if (insert(stamp, std::move(value))) removable_ = holds ? std::optional(stamp) : std::nullopt;
  }

  /// The source withdraws its value, from right after the stamp that arrived last.
  void withdraw() {
    if (removable_ && *removable_ < std::numeric_limits<Nanoseconds>::max()) insert(*removable_ + 1, std::nullopt);
    removable_.reset();
  }

  /// The last entry at or before `time`, when it has a value and is not older than `timeout`; else
  /// null.
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

  /// Discards what at(time) and later calls do not need.
  void discardBefore(Nanoseconds time) {
    for (; entries_.size() > 1 && entries_[1].stamp <= time; entries_.pop_front()) forgot_ = true;
  }

  std::size_t size() const { return entries_.size(); }

 private:
  using Iterator = typename std::deque<Entry>::const_iterator;

  Iterator firstStampAfter(Nanoseconds time) const {
    return std::upper_bound(entries_.begin(), entries_.end(), time,
                            [](Nanoseconds wanted, const Entry& entry) { return wanted < entry.stamp; });
  }

  /// Returns false when the stamp is before the discarded entries.
  bool insert(Nanoseconds stamp, std::optional<Value> value) {
    const Iterator after = firstStampAfter(stamp);
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
  bool forgot_ = false;                   ///< older entries were discarded
  std::optional<Nanoseconds> removable_;  ///< stamp that arrived last; empty when its value was withdrawn
};

}  // namespace microinjection
