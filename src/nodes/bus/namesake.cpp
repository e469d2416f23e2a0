#include "nodes/bus/namesake.h"

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <thread>

namespace microinjection {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kAnswer(500);   // within which a node that is not frozen answers
constexpr milliseconds kEnding(2000);  // for a namesake that is about to end
constexpr milliseconds kPause(100);

std::string registeredNamesake() {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = request[1] = ros::this_node::getName();
  if (!ros::master::execute("lookupNode", request, response, uri, false)) return "";
  return uri.getType() == XmlRpc::XmlRpcValue::TypeString ? std::string(uri) : "";
}

/// A call cannot be broken off: its thread is left alone with what it needs.
bool answers(const std::string& uri) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return false;
  const auto answered = std::make_shared<std::promise<bool>>();
  std::future<bool> result = answered->get_future();
  std::thread([answered, host, port] {
    XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port));
    XmlRpc::XmlRpcValue request, response;
    request[0] = "namesake";
    answered->set_value(client.execute("getPid", request, response));
  }).detach();
  return result.wait_for(kAnswer) == std::future_status::ready && result.get();
}

}  // namespace

std::string livingNamesake() {
  for (const auto begin = steady_clock::now();; std::this_thread::sleep_for(kPause)) {
    const std::string uri = registeredNamesake();
    if (uri.empty() || !answers(uri)) return "";
    if (steady_clock::now() - begin > kEnding) return uri;
  }
}

}  // namespace microinjection
