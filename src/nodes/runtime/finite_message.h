#pragma once

#include <ros/serialization.h>
#include <ros/time.h>

#include <boost/array.hpp>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

namespace microinjection {
namespace detail {

/// Visits a message's fields like a serialiser and checks the floating-point numbers.
class FiniteFields {
 public:
  template <typename T>
  void next(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      finite_ = finite_ && std::isfinite(value);
    } else if constexpr (!std::is_arithmetic_v<T>) {
      ros::serialization::Serializer<T>::template allInOne<FiniteFields, const T&>(*this, value);
    }
  }
  template <typename T, typename Allocator>
  void next(const std::vector<T, Allocator>& values) {
    for (const T& value : values) next(value);
  }
  template <typename T, std::size_t N>
  void next(const boost::array<T, N>& values) {
    for (const T& value : values) next(value);
  }
  void next(const std::string&) {}
  void next(const ros::Time&) {}
  void next(const ros::Duration&) {}

  bool finite() const { return finite_; }

 private:
  bool finite_ = true;
};

}  // namespace detail

/// Whether all floating-point numbers of a message are finite, in any field, array or nested
/// message.
template <typename Message>
bool isFinite(const Message& message) {
  detail::FiniteFields fields;
  fields.next(message);
  return fields.finite();
}

}  // namespace microinjection
