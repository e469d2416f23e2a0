#include "nodes/bus/lost_publishers.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <cstdint>
#include <utility>

namespace microinjection {
namespace {

constexpr bool kWaitForMaster = false;  ///< for an absent master
constexpr int kTries = 3;               ///< a killed publisher stays registered at the master

}  // namespace

std::map<std::string, std::vector<std::string>> publishersAtMaster() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  std::map<std::string, std::vector<std::string>> result;
  if (!ros::master::execute("getSystemState", request, response, state, kWaitForMaster)) return result;
  XmlRpc::XmlRpcValue& publishers = state[0];  // [topic, [name, ...]] each
  for (int i = 0; i < publishers.size(); ++i) {
    std::vector<std::string>& names = result[publishers[i][0]];
    for (int j = 0; j < publishers[i][1].size(); ++j) {
      const std::string name = publishers[i][1][j];
      if (name != ros::this_node::getName()) names.push_back(name);
    }
  }
  return result;
}

bool LostPublishers::connect(const std::string& topic, const std::vector<std::string>& publishers) {
  XmlRpc::XmlRpcValue update, response, uris;
  uris.setSize(0);
  for (const std::string& name : publishers) {
    XmlRpc::XmlRpcValue request, reply, uri;
    request[0] = ros::this_node::getName();
    request[1] = name;
    // The list must be complete: roscpp drops the connections to publishers that are not in it.
    if (!ros::master::execute("lookupNode", request, reply, uri, kWaitForMaster)) return false;
    uris[uris.size()] = uri;
  }
  update[0] = "/master";
  update[1] = topic;
  update[2] = uris;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port)) return false;
  XmlRpc::XmlRpcClient self(host.c_str(), static_cast<int>(port), "/");
  return self.execute("publisherUpdate", update, response);
}

void LostPublishers::check() {
  try {
    compare();
  } catch (const XmlRpc::XmlRpcException&) {
    // The reply is not that of a ROS master.
  }
}

void LostPublishers::compare() {
  if (ros::isShuttingDown()) return;
  ros::V_string subscribed;
  ros::this_node::getSubscribedTopics(subscribed);
  const auto topics = publishersAtMaster();
  for (const std::string& topic : subscribed) {
    const auto registered = topics.find(topic);
    if (registered == topics.end() ||
        ros::TopicManager::instance()->getNumPublishers(topic) >= registered->second.size()) {
      missing_.erase(topic);
      continue;
    }
    Missing& missing = missing_[topic];
    if (missing.publishers != registered->second) missing = {registered->second, false, 0};
    // Only at the second check: at the first the connection may still be under way.
    if (!std::exchange(missing.seen, true) || missing.tries == kTries) continue;
    if (connect(topic, registered->second)) ++missing.tries;
  }
}

}  // namespace microinjection
