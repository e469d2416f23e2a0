#pragma once

#include <ros/message_event.h>
#include <ros/message_traits.h>
#include <ros/ros.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>

#include <cstdint>
#include <functional>
#include <string>

namespace microinjection {

/// A message as a bus delivers it to a subscription, its type erased.
struct RawDelivery {
  boost::shared_ptr<const void> message;
  std::string sender;                        ///< node
  ros::Time received;                        ///< arrival at the subscriber's process
  bool latched = false;                      ///< the publisher latches: the message may be of any age
  boost::shared_ptr<const void> connection;  ///< the same for all messages of a connection
};
using RawHandler = std::function<void(const RawDelivery&)>;

/// What a bus has to know of a message type. Buses handle messages with their types erased, so that
/// their interface can be virtual; these functions restore the type.
struct MessageType {
  const char* name;  ///< such as geometry_msgs/PoseStamped
  const char* md5;   ///< of the definition; different ones do not connect

  ros::Publisher (*advertise)(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue, bool latch);
  void (*publish)(const ros::Publisher& publisher, const void* message);
  void (*publish_shared)(const ros::Publisher& publisher, const boost::shared_ptr<const void>& message);
  ros::Subscriber (*subscribe)(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue,
                               const RawHandler& handler);
  /// A copy whose header, if it has one, has this sequence number, as roscpp's publishers count.
  boost::shared_ptr<const void> (*copy)(const void* message, std::uint32_t sequence);
  /// In ROS' serialisation, for programs that know types by name only; null for bytes that are no such message.
  std::string (*serialize)(const void* message);
  boost::shared_ptr<const void> (*deserialize)(const std::string& bytes);
};

namespace detail {

template <typename Message>
bool isLatched(const ros::MessageEvent<const Message>& event) {
  const auto& header = event.getConnectionHeader();
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

template <typename Message>
struct TypedMessage {
  static ros::Publisher advertise(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue, bool latch) {
    return node.advertise<Message>(topic, queue, latch);
  }
  static void publish(const ros::Publisher& publisher, const void* message) {
    publisher.publish(*static_cast<const Message*>(message));
  }
  static void publishShared(const ros::Publisher& publisher, const boost::shared_ptr<const void>& message) {
    publisher.publish(boost::const_pointer_cast<Message>(boost::static_pointer_cast<const Message>(message)));
  }
  static ros::Subscriber subscribe(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue,
                                   const RawHandler& handler) {
    using Event = ros::MessageEvent<const Message>;
    const auto receive = [handler](const Event& event) {
      handler({event.getConstMessage(), event.getPublisherName(), event.getReceiptTime(), isLatched(event),
               event.getConnectionHeaderPtr()});
    };
    return node.subscribe<Message, const Event&>(topic, queue, receive, {}, ros::TransportHints().tcpNoDelay());
  }
  static boost::shared_ptr<const void> copy(const void* message, std::uint32_t sequence) {
    const auto copied = boost::make_shared<Message>(*static_cast<const Message*>(message));
    if constexpr (ros::message_traits::HasHeader<Message>::value) copied->header.seq = sequence;
    return copied;
  }
  static std::string serialize(const void* message) {
    const auto& typed = *static_cast<const Message*>(message);
    std::string bytes(ros::serialization::serializationLength(typed), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, typed);
    return bytes;
  }
  static boost::shared_ptr<const void> deserialize(const std::string& bytes) {
    const auto message = boost::make_shared<Message>();
    std::string copied = bytes;
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(copied.data()),
                                       static_cast<std::uint32_t>(copied.size()));
    try {
      ros::serialization::deserialize(stream, *message);
    } catch (const ros::serialization::StreamOverrunException&) {
      return nullptr;
    }
    return message;
  }
};

}  // namespace detail

template <typename Message>
const MessageType& messageType() {
  using Typed = detail::TypedMessage<Message>;
  static const MessageType type{ros::message_traits::DataType<Message>::value(),
                                ros::message_traits::MD5Sum<Message>::value(),
                                Typed::advertise,
                                Typed::publish,
                                Typed::publishShared,
                                Typed::subscribe,
                                Typed::copy,
                                Typed::serialize,
                                Typed::deserialize};
  return type;
}

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
