#pragma once

#include <functional>
#include <mutex>
#include <string>

namespace microinjection {

/// gmsh keeps one global state: one session at a time, with a model of its own, closed on every way out. Silent and
/// deterministic: one thread, fixed seed, errors as exceptions; sizes come from the size callback only.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
};

/// Runs `work` in a session. What gmsh throws becomes a std::runtime_error that says which `subject` failed.
void inGmshSession(const std::string& subject, const std::function<void()>& work);

/// Version of gmsh, as its header names it.
std::string gmshVersion();

}  // namespace microinjection
