#include "nodes/runtime/lost_publishers.h"

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

constexpr bool kWait = false;  ///< for a master that is not there
constexpr int kMostTries = 3;  ///< a publisher that was killed stays at the master

}  // namespace

LostPublishers::Topics LostPublishers::publishersAtMaster() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  Topics result;
  if (!ros::master::execute("getSystemState", request, response, state, kWait)) return result;
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
    XmlRpc::XmlRpcValue request, answer, uri;
    request[0] = ros::this_node::getName();
    request[1] = name;
    // Never a part of the list: roscpp drops the connections to all that are not in it.
    if (!ros::master::execute("lookupNode", request, answer, uri, kWait)) return false;
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
    // Whoever answers so is no master.
  }
}

void LostPublishers::compare() {
  if (ros::isShuttingDown()) return;
  ros::V_string subscribed;
  ros::this_node::getSubscribedTopics(subscribed);
  const Topics topics = publishersAtMaster();
  for (const std::string& topic : subscribed) {
    const auto known = topics.find(topic);
    if (known == topics.end() || ros::TopicManager::instance()->getNumPublishers(topic) >= known->second.size()) {
      missing_.erase(topic);
      continue;
    }
    Missing& missing = missing_[topic];
    if (missing.publishers != known->second) missing = {known->second, false, 0};
    // At the second look only: at the first the connection may be on its way.
    if (!std::exchange(missing.seen, true) || missing.tries == kMostTries) continue;
    if (connect(topic, known->second)) ++missing.tries;
  }
}

}  // namespace microinjection
