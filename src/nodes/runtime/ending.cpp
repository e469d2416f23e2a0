#include "nodes/runtime/ending.h"

#include <ros/init.h>
#include <ros/xmlrpc_manager.h>

#include <csignal>

namespace microinjection {
namespace {

volatile std::sig_atomic_t asked = 0;

void onSignal(int) {
  if (asked) ros::requestShutdown();
  asked = 1;
}

void onShutdownCall(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
  asked = 1;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

void endInGoodOrder() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  // Bound before ROS starts, which then leaves the name as it is.
  ros::XMLRPCManager::instance()->bind("shutdown", onShutdownCall);
}

bool shutdownRequested() { return asked != 0; }

}  // namespace microinjection
