#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace microinjection {

/// Appends numbers in the machine's own format, for caches on the machine that wrote them.
class ByteWriter {
 public:
  template <typename T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// Appends the size and the elements of anything with data() and size().
  template <typename Array>
  void array(const Array& values) {
    number<std::uint64_t>(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(*values.data()));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what ByteWriter wrote. The bytes must outlive the reader. Throws std::runtime_error at
/// their end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, consume(sizeof(T)), sizeof(T));
    return value;
  }
  /// Resizes `values` to the stored size.
  template <typename Array>
  void array(Array& values) {
    const auto size = number<std::uint64_t>();
    if (size > bytes_.size()) throw std::runtime_error("there is less than was written");
    values.resize(size);
    const std::size_t length = size * sizeof(*values.data());
    std::memcpy(static_cast<void*>(values.data()), consume(length), length);
  }
  bool atEnd() const { return at_ == bytes_.size(); }

 private:
  const char* consume(std::size_t length) {
    if (length > bytes_.size() - at_) throw std::runtime_error("there is less than was written");
    const char* result = bytes_.data() + at_;
    at_ += length;
    return result;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace microinjection
