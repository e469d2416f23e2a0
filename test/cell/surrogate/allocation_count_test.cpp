#include "cell/surrogate/allocation_count.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <memory>

#ifdef __has_feature
#define MICROINJECTION_HAS_FEATURE(name) __has_feature(name)
#else
#define MICROINJECTION_HAS_FEATURE(name) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || MICROINJECTION_HAS_FEATURE(address_sanitizer) || \
    MICROINJECTION_HAS_FEATURE(thread_sanitizer)
#define MICROINJECTION_SANITIZED 1
// The sanitizers' own; the header that declares it is not installed with every compiler.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*allocated)(const volatile void*, std::size_t),
                                                         void (*freed)(const volatile void*));
#else
#define MICROINJECTION_SANITIZED 0
// glibc's own names of what is put in their place below.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}
#endif

namespace {
thread_local std::size_t allocations = 0;
}

#if MICROINJECTION_SANITIZED
namespace {
// A sanitizer has put its own malloc in glibc's place and must keep it: blocks that it does not know of end the program
// when they are freed, before the first test. It counts through a hook.
const int installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { ++allocations; }, [](const volatile void*) {});
}  // namespace
#else
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
#endif

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
