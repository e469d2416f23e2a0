#include "nodes/runtime/network_monitor.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <array>
#include <chrono>

#include "nodes/runtime/real_time.h"

namespace microinjection {
namespace {

constexpr std::chrono::seconds kInterfaceCheckPeriod(1);

/// Returns empty for another family than IP.
std::string addressOf(const ifaddrs& interface) {
  if (!interface.ifa_addr) return "";
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = interface.ifa_addr->sa_family;
  const void* address = nullptr;
  if (family == AF_INET) address = &reinterpret_cast<const sockaddr_in*>(interface.ifa_addr)->sin_addr;
  if (family == AF_INET6) address = &reinterpret_cast<const sockaddr_in6*>(interface.ifa_addr)->sin6_addr;
  return address && inet_ntop(family, address, text.data(), text.size()) ? text.data() : "";
}

std::string reachableInterfaces() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "interfaces that cannot be listed";
  std::string names;
  for (const ifaddrs* each = all; each; each = each->ifa_next) {
    const auto has = [each](unsigned flag) { return (each->ifa_flags & flag) != 0; };
    const bool counts = has(IFF_UP) && has(IFF_RUNNING) && !has(IFF_LOOPBACK);  // running: its cable is connected
    const std::string address = counts ? addressOf(*each) : "";
    if (!address.empty()) names += (names.empty() ? "" : ", ") + std::string(each->ifa_name) + " (" + address + ")";
  }
  freeifaddrs(all);
  return names;
}

}  // namespace

NetworkMonitor::NetworkMonitor() {
  check();
  thread_ = std::thread([this] {
    preferForThread(Priority::kOrdinary);
    std::unique_lock<std::mutex> lock(mutex_);
    while (!changed_.wait_for(lock, kInterfaceCheckPeriod, [this] { return ending_; })) {
      lock.unlock();
      check();
      lock.lock();
    }
  });
}

NetworkMonitor::~NetworkMonitor() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void NetworkMonitor::check() {
  std::string found = reachableInterfaces();
  const std::lock_guard<std::mutex> lock(mutex_);
  reachable_ = !found.empty();
  interfaces_ = std::move(found);
}

std::string NetworkMonitor::interfaces() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return interfaces_;
}

}  // namespace microinjection
