#include "session/session_check.h"

#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

class Check {
 public:
  explicit Check(const Session& session) : session_(session) {}

  void run() {
    checkHidden();
    checkHolder();
    checkEstimator();
    checkForces();
    checkInjection();
    checkCamera();
    checkDisplay();
    checkRecord();
    if (!errors_.empty()) throw ConfigError(errors_);
  }

 private:
  /// "lab.yaml, line 3: KEY = VALUE with OTHERS: must be ALLOWED".
  void refuse(const std::string& key, const std::string& value, const std::string& others, const std::string& allowed) {
    errors_.push_back(session_.places.at(key) + ": " + key + " = " + value + (others.empty() ? "" : " with " + others) +
                      ": must be " + allowed);
  }
  std::string rig() const { return "rig/name = " + session_.rig.name; }
  bool hasSensor() const { return session_.sensor.source != "none"; }

  void checkHidden() {
    if (!session_.hidden.empty() && session_.rig.real())
      refuse("hidden", session_.hidden, rig(), "with sim or an emulated rig; a real one has its own cell");
  }

  /// Two drivers on one line would each hear the other's answers.
  void checkHolder() {
    const Session::Manipulator &needle = session_.rig, &holder = session_.holder_rig;
    if (!needle.real() || !holder.real()) return;
    const bool same_node = needle.external() && holder.external() && needle.name_space == holder.name_space;
    if (same_node) refuse("holder_rig/namespace", holder.name_space, rig(), "another one than rig/namespace");
    const bool has_ports = !needle.external() && !holder.external();
    const bool same_port = needle.port == holder.port && (needle.port != "auto" || needle.config == holder.config);
    if (has_ports && same_port) refuse("holder_rig/port", holder.port, rig(), "another one than rig/port");
  }

  void checkEstimator() {
    if (!session_.estimator) return;
    if (!hasSensor() && session_.camera.source == "none") {
      refuse(
          "estimator", "true", "sensor/source = none and camera/source = none",
          "with a force sensor, which shows modulus and height of the cell, or with a camera, which shows the height");
    }
    if (session_.rig.real() && !hasSensor()) {
      refuse("estimator", "true", "sensor/source = none and " + rig(),
             "with a force sensor on a real rig: an image does not show the puncture");
    } else if (session_.rig.real() && session_.force.controller != "measured") {
      refuse("estimator", "true", "force/controller = " + session_.force.controller + " and " + rig(),
             "with measured on a real rig, whose puncture the predicted force does not show");
    }
  }

  void checkForces() {
    if (hasSensor()) return;
    const Session::Force& force = session_.force;
    const std::string allowed = "predicted, or with a force sensor";
    if (force.controller != "predicted") refuse("force/controller", force.controller, "sensor/source = none", allowed);
    if (force.hand != "predicted" && force.hand != force.controller && session_.hand.present())
      refuse("force/hand", force.hand, "sensor/source = none", allowed);
  }

  void checkInjection() {
    if (session_.injection.mode != "manual" && session_.hand.present())
      refuse("injection/mode", session_.injection.mode, "hand/device = " + session_.hand.device,
             "manual, or with hand/device = none");
  }

  void checkCamera() {
    const std::string& source = session_.camera.source;
    if ((source == "folder" || source == "video") && session_.camera.path.empty())
      refuse("camera/source", source, "camera/path = \"\"", "with the path of the recording");
  }

  void checkDisplay() {
    const Session::Display& display = session_.display;
    if (display.markers) return;
    const std::string allowed = "with display/markers = true, which it shows";
    if (display.rviz) refuse("display/rviz", "true", "display/markers = false", allowed);
    if (display.console != "none") refuse("display/console", display.console, "display/markers = false", allowed);
  }

  void checkRecord() {
    const Session::Record& record = session_.record;
    if (!record.folder.empty()) return;
    const std::string allowed = "with the folder of a record, ";
    if (!record.trainee.empty())
      refuse("record/trainee", record.trainee, "record/folder = \"\"", allowed + "whose session is scored");
    if (record.end_when_done)
      refuse("record/end_when_done", "true", "record/folder = \"\"", allowed + "whose recorder ends the session");
  }

  const Session& session_;
  std::vector<std::string> errors_;
};

}  // namespace

void checkSession(const Session& session) { Check(session).run(); }

}  // namespace microinjection
