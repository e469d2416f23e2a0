#pragma once

#include <ros/ros.h>
#include <ros/service_traits.h>

#include <functional>
#include <string>

namespace microinjection {

/// Answers a request; false: it fails, as in roscpp.
using RawAnswer = std::function<bool(void* request, void* response)>;

/// What a bus has to know of a service type; see MessageType.
struct ServiceType {
  const char* name;
  const char* md5;

  ros::ServiceServer (*advertise)(ros::NodeHandle& node, const std::string& service, const RawAnswer& answer);
  /// Waits for the answer, as long as the server takes.
  bool (*call)(ros::NodeHandle& node, const std::string& service, void* call);
  /// Has `answer` fill the response of `call` in.
  bool (*answer)(const RawAnswer& answer, void* call);
};

namespace detail {

template <typename Service>
struct TypedService {
  using Request = typename Service::Request;
  using Response = typename Service::Response;

  static ros::ServiceServer advertise(ros::NodeHandle& node, const std::string& service, const RawAnswer& answer) {
    return node.advertiseService<Request, Response>(
        service, [answer](Request& request, Response& response) { return answer(&request, &response); });
  }
  static bool call(ros::NodeHandle& node, const std::string& service, void* call) {
    return node.serviceClient<Service>(service).call(*static_cast<Service*>(call));
  }
  static bool answer(const RawAnswer& answer, void* call) {
    auto& typed = *static_cast<Service*>(call);
    return answer(&typed.request, &typed.response);
  }
};

}  // namespace detail

template <typename Service>
const ServiceType& serviceType() {
  using Typed = detail::TypedService<Service>;
  static const ServiceType type{ros::service_traits::DataType<Service>::value(),
                                ros::service_traits::MD5Sum<Service>::value(), Typed::advertise, Typed::call,
                                Typed::answer};
  return type;
}

}  // namespace microinjection
