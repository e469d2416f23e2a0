#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <memory>
#include <vector>

#include "nodes/runtime/ports.h"
#include "nodes/runtime/stall_monitor.h"

namespace microinjection {

/// Topics of a cycle, and the queues that their callbacks run from.
struct CyclePorts {
  explicit CyclePorts(const ros::NodeHandle& handle) : node(handle), sampled_node(handle) {
    node.setCallbackQueue(&queue);
    sampled_node.setCallbackQueue(&sampled_queue);
  }

  ros::CallbackQueue queue;          ///< wakes the node up
  ros::CallbackQueue sampled_queue;  ///< read before a step: to wake up for it would cost more than the step
  ros::NodeHandle node;
  ros::NodeHandle sampled_node;
  std::vector<std::unique_ptr<InputPort>> inputs;
  std::vector<std::unique_ptr<OutputPort>> outputs;
  std::vector<ros::Subscriber> subscribers;
  StallMonitor stalls;
};

}  // namespace microinjection
