#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// Where each key of a session was set: a file and its line, or an argument. An error names it: a session may be made
/// of several files, and a key may be set in each of them.
struct SessionPlaces {
  std::string source;                     ///< the session's file
  std::map<std::string, std::string> of;  ///< place by key; keys at their defaults are absent

  /// Of a key such as "rig/name", or "overrides/display/enlargement"; of one at its default, the session's file.
  std::string at(const std::string& key) const;
};

/// A session: what takes part in it, and what of it is to differ from its configuration. It is the content of a file
/// config/sessions/NAME.yaml, whose keys are the members here; config/sessions/default.yaml describes each of them.
///
///     the defaults below <-- base of lab.yaml <-- lab.yaml <-- arguments KEY:=VALUE      each over the ones before
///                                                            |
///                                         checkSession(): what does not go together
///                                                            |
///                   Session --> planOf() --> SessionPlan --> session.launch, `session`, simulate, tests
///
/// Launch arguments, which a session was made of before, cannot be kept with a record or shared in a lab, nobody but
/// roslaunch can read them, and it can hardly say which of them exclude each other. With a file, a strict reader and
/// a room without ROS a session is refused as a whole, with a line for each error, before any node starts; and the
/// same file runs live, in `simulate` and in a test.
///
/// In a file, `auto` stands for a value that follows from other keys, so that another rig or hand takes one key. Once
/// loaded, all paths are absolute, all values go together, and `auto` is left only where a comment names it.
struct Session {
  static constexpr int kVersion = 1;  ///< of the files

  struct Manipulator {
    std::string name = "none";        ///< sim, a name of config/rigs, emulated_NAME, or none
    std::string port = "auto";        ///< auto: that of config, or the emulator's
    std::string name_space = "auto";  ///< of external: of its node's topics; auto: that of config
    std::string config;               ///< path of the device's parameters; empty with none
    std::string urdf;                 ///< path: of the rig, or of the holding pipette's axes alone; empty with none

    bool present() const { return name != "none"; }
    bool simulated() const { return name == "sim"; }
    bool emulated() const { return name.rfind("emulated_", 0) == 0; }
    bool external() const { return name == "external"; }
    bool real() const { return present() && !simulated() && !emulated(); }
    std::string device() const { return emulated() ? name.substr(9) : name; }  ///< sim, none, or a name of config/rigs
  };
  struct Rig : Manipulator {
    Rig() { name = "sim"; }
    bool allow_network = true;
  };
  struct Sensor {
    std::string source = "simulated";                        ///< simulated, serial, topic, none
    std::array<double, 6> mounting = {0, 0, 0.04, 0, 0, 0};  ///< in needle_tip: x y z (m) yaw pitch roll (rad)
    bool quiet = false;                                      ///< its noise is below its step
  };
  /// Of the device's driver. auto: as the file of the device says; of `external`, see there.
  struct Topics {
    std::string name_space = "auto";        ///< external: /haptic
    std::string force = "auto";             ///< of external only: servo_cf in that namespace
    std::string clutch = "auto";            ///< external: clutch in that namespace
    std::string operator_present = "auto";  ///< external: operator_present in that namespace
  };
  struct Hand {
    std::string device = "virtual_hand";  ///< virtual_hand, none or a name of config/haptic
    std::string config;                   ///< path of the device's parameters; empty with virtual_hand and none
    Topics topics;
    std::string position_type = "auto";  ///< pose or transform; auto: that of config
    bool require_operator = true;
    std::string motion;        ///< path, of the virtual hand
    bool wait_for_go = false;  ///< the virtual hand rests until it is told to begin

    bool present() const { return device != "none"; }
    bool isVirtual() const { return device == "virtual_hand"; }
  };
  struct Force {
    std::string controller = "predicted";  ///< predicted or measured
    std::string hand = "predicted";        ///< predicted, measured or blend
  };
  struct Injection {
    std::string mode = "manual";  ///< manual, automatic or semi_automatic
    bool auto_enable = true;
    bool start_when_enabled = true;
    int layers = 1;  ///< membranes to puncture
  };
  struct Link {
    std::string scheme = "none";             ///< none or wave
    double delay = 0, jitter = 0, loss = 0;  ///< s, s, share of packets
    bool emulated = false;
  };
  struct Camera {
    std::string source = "none";  ///< none, sim, device, folder, video, topic
    std::string config;           ///< path, of a device
    std::string path;             ///< of a folder or video
    std::string topic = "/camera/image_raw";
  };
  struct Display {
    bool markers = true, rviz = false;
    std::string console = "none";  ///< none or a name of config/console
  };
  struct Record {
    std::string folder;  ///< path; empty: nothing is recorded
    bool bag = true, end_when_done = false;
    std::string trainee;   ///< empty: no score
    std::string history;   ///< path
    std::string training;  ///< path of the score's references
  };

  std::string package;         ///< folder with config and urdf
  std::string cell;            ///< path of the scene that the session believes in
  std::string hidden;          ///< path of the scene under the needle; empty: that of `cell`
  std::string model = "auto";  ///< auto (the cheapest that meets the scene's requirements), surrogate, live or explicit
  bool estimator = false;
  Rig rig;
  Manipulator holder_rig;  ///< of the holding pipette
  Sensor sensor;
  std::string injector = "simulated";
  std::string holder = "none";  ///< none, sim, a name of config/injectors, emulated_NAME, serial
  Hand hand;
  Force force;
  Injection injection;
  Link link;
  Camera camera;
  Display display;
  Record record;
  std::string notebook;        ///< path; empty: none
  std::optional<double> rate;  ///< 1/s, the largest of any loop; none: as each node's configuration says
  YAML::Node overrides;        ///< {NODE: {KEY: VALUE}}, and {rig: {start_height: ...}}

  SessionPlaces places;
  std::vector<std::string> files;  ///< that were read: the session's, its bases, and those of overrides

  /// Loads a session file, or NAME of config/sessions, and sets the keys of `arguments`: "hand.device:=keyboard" or
  /// "hand.device=keyboard". A value that is a list, a map or a text in quotes is YAML; a key without a value is passed
  /// over. A path in a file is relative to that file, one in an argument to the working directory. Throws ConfigError
  /// with all errors.
  static Session load(const std::string& file_or_name, const std::vector<std::string>& arguments = {},
                      const std::string& package = "");
  /// All keys, as a file that loads as this session.
  std::string text() const;
};

/// Nodes whose parameters a session may override, and rig, whose values are heights and sizes of the URDF, in m.
const std::vector<std::string>& overridableNodes();

}  // namespace microinjection
