#pragma once

#include <functional>
#include <mutex>
#include <string>

namespace microinjection {

/// gmsh has one global state, so only one session exists at a time. It has a model of its own, and
/// the destructor closes it. It is silent and deterministic: one thread, fixed seed, errors as
/// exceptions, sizes from the size callback only.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
};

/// Runs `work` in a session. An error of gmsh becomes a std::runtime_error that names `subject`.
void inGmshSession(const std::string& subject, const std::function<void()>& work);

/// Version of gmsh, as its header names it.
std::string gmshVersion();

}  // namespace microinjection
