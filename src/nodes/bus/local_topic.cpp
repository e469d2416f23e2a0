#include "nodes/bus/local_topic.h"

#include <algorithm>

namespace microinjection {

std::size_t LocalPublisher::subscribers() const {
  if (!topic_) return 0;
  const auto& all = topic_->subscriptions;
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const auto& one) { return !one.expired(); }));
}

bool LocalPublisher::isSubscribedBy(const std::string& node) const {
  if (!topic_) return false;
  const auto& all = topic_->subscriptions;
  return std::any_of(all.begin(), all.end(), [&](const auto& one) {
    const auto subscription = one.lock();
    return subscription && subscription->bus.name() == node;
  });
}

LocalSubscription::~LocalSubscription() {
  if (serving == Serving::kDrives) --bus.driving_;
  auto& all = topic.subscriptions;
  all.erase(std::remove_if(all.begin(), all.end(), [](const auto& one) { return one.expired(); }), all.end());
  ++bus.network_.changes_;
}

std::size_t LocalSubscription::publishers() const { return topic.publishers.size(); }

}  // namespace microinjection
