#include "surrogate/allocation_count.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>

// glibc's own names of what is put in their place below.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {
thread_local std::size_t allocations = 0;
}

extern "C" {
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}

namespace microinjection {

std::size_t allocationCount() { return allocations; }

namespace {

TEST(AllocationCount, SeesNewAndEigen) {
  const std::size_t before = allocationCount();
  const auto number = std::make_unique<int>(1);
  EXPECT_EQ(allocationCount(), before + 1);
  const Eigen::VectorXd vector = Eigen::VectorXd::Constant(50, *number);
  EXPECT_EQ(allocationCount(), before + 2) << vector.size();
}

}  // namespace
}  // namespace microinjection
