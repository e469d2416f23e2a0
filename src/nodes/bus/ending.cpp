#include "nodes/bus/ending.h"

#include <ros/init.h>
#include <ros/xmlrpc_manager.h>

#include <csignal>

namespace microinjection {
namespace {

volatile std::sig_atomic_t requested = 0;

void onSignal(int) {
  if (requested) ros::requestShutdown();
  requested = 1;
}

void onShutdownCall(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
  requested = 1;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

void endInGoodOrder() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, onSignal);
  // ROS does not replace a name that is bound before it starts.
  ros::XMLRPCManager::instance()->bind("shutdown", onShutdownCall);
}

bool shutdownRequested() { return requested != 0; }

}  // namespace microinjection
