#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <string>

namespace microinjection {

/// The part of a message's definition for a message type that it contains.
template <typename Message>
std::string containedDefinition() {
  return "\n" + std::string(80, '=') + "\nMSG: " + ros::message_traits::DataType<Message>::value() + "\n" +
         ros::message_traits::Definition<Message>::value();
}

}  // namespace microinjection

/// Makes a plain struct a message of another package, to exchange it with that package's nodes
/// without a dependency.
///
/// KIND is TrueType when the struct has a header. TYPE, MD5 and DEFINITION (a std::string, with
/// contained messages) are those of that package's generated code; a test computes the md5 sum from
/// the definition. The last argument streams the members of `message` in their order.
#define MICROINJECTION_FOREIGN_MESSAGE(STRUCT, KIND, TYPE, MD5, DEFINITION, ...)                \
  namespace ros {                                                                               \
  namespace message_traits {                                                                    \
  template <>                                                                                   \
  struct IsMessage<STRUCT> : TrueType {};                                                       \
  template <>                                                                                   \
  struct IsMessage<const STRUCT> : TrueType {};                                                 \
  template <>                                                                                   \
  struct HasHeader<STRUCT> : KIND {};                                                           \
  template <>                                                                                   \
  struct HasHeader<const STRUCT> : KIND {};                                                     \
  template <>                                                                                   \
  struct DataType<STRUCT> {                                                                     \
    static const char* value() { return TYPE; }                                                 \
    static const char* value(const STRUCT&) { return value(); }                                 \
  };                                                                                            \
  template <>                                                                                   \
  struct MD5Sum<STRUCT> {                                                                       \
    static const char* value() { return MD5; }                                                  \
    static const char* value(const STRUCT&) { return value(); }                                 \
  };                                                                                            \
  template <>                                                                                   \
  struct Definition<STRUCT> {                                                                   \
    static const char* value() {                                                                \
      static const std::string text = DEFINITION;                                               \
      return text.c_str();                                                                      \
    }                                                                                           \
    static const char* value(const STRUCT&) { return value(); }                                 \
  };                                                                                            \
  }                                                                                             \
  namespace serialization {                                                                     \
  template <>                                                                                   \
  struct Serializer<STRUCT> {                                                                   \
    template <typename Stream, typename T>                                                      \
    static void allInOne(Stream& stream, T message) __VA_ARGS__ ROS_DECLARE_ALLINONE_SERIALIZER \
  };                                                                                            \
  }                                                                                             \
  }
