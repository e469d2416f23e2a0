#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "hardware/devices/manipulator_emulator.h"
#include "hardware/devices/zaber/zaber_emulated_axis.h"

namespace microinjection {

struct ZaberEmulatorConfig {
  std::array<int, 3> devices{1, 1, 1};  ///< device number of each axis; three chained devices: 1, 2, 3
  std::array<int, 3> axes{1, 2, 3};     ///< number of each axis in its device; three chained devices: 1, 1, 1
  double microstep = 0.047625e-6;       ///< m
  double travel = 25e-3;                ///< m, from 0
  double start = 12.5e-3;               ///< m, of every axis
  double acceleration = 0.2;            ///< m/s^2, initial settings, up and down
  double speed = 5e-3;                  ///< m/s, initial setting maxspeed
  double answer_time = 1e-3;            ///< s, from the end of a command to the start of its reply
  std::string firmware = "7.25";        ///< MAJOR.MINOR, reply to `get version`
  bool referenced = true;               ///< false: axes warn WR and refuse absolute moves until homed
  bool alerts = false;                  ///< setting comm.alert: an axis that comes to rest sends an alert
  bool checksum = false;                ///< setting comm.checksum: messages have one
  int serial = 12340;                   ///< added to a device's number: its serial number
  std::vector<std::string> without;     ///< settings that its firmware does not have
  int info_every = 0;                   ///< an info line after every n-th reply; 0: only after that to `help`
};

/// Emulates Zaber devices with the ASCII protocol. It is based on the protocol's manuals and on
/// public clients, not on the driver. Sources and unverified points: doc/reference/devices.md.
///
/// "/1 2 7 get pos" asks device 1, axis 2 with message ID 7; each of the three may be left out with
/// those after it ("/1 get pos", "/home"), and a message ID "--" asks for no reply. Axis 0, or none,
/// is all axes of a device, which replies once, with the data of all of them; device 0, or none, is
/// all devices. A reply shows only its most important flag; `warnings` lists all. From firmware
/// 7.25 on a move may have its own speed and acceleration, in the data of maxspeed and accel;
/// earlier firmware refuses such a move.
///
/// Errors that can be injected: a reason of rejection (BADDATA, AGAIN, ...) for the next command; a
/// flag of two characters (FS: stalled), which stays on all axes until `warnings clear`; RESET: the
/// devices were switched off and on.
class ZaberEmulator : public ManipulatorEmulator {
 public:
  explicit ZaberEmulator(const ZaberEmulatorConfig& config = {});
  ZaberEmulator(const ZaberEmulator&) = delete;
  ZaberEmulator& operator=(const ZaberEmulator&) = delete;

  Eigen::Vector3d position() const override;
  int movesBegun() const override;
  bool moves() const override;
  void shiftByHand(const Eigen::Vector3d& displacement) override;
  void setFirmware(const std::string& version) override;
  void configure(ConfigReader& reader) override;

 protected:
  void process(const std::string& bytes, double time) override;
  void advance(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override;
  void interrupt(double time) override;

 private:
  struct Device {
    std::map<int, ZaberEmulatedAxis*> axes;  // by number
    int access = 1;                          // setting system.access
    bool alerts = false, checksum = false;
  };
  struct Command {
    int device = 0, axis = 0;
    std::string id;       // message ID and a blank, or nothing
    bool answers = true;  // false: its message ID is "--"
    std::vector<std::string> words;
  };

  void build();
  void handleCommand(const std::string& line);
  void handleCommand(int number, Device& device, const Command& command);
  std::string perform(int number, Device& device, const Command& command);
  std::string performOnAxes(Device& device, const Command& command);
  std::string get(int number, const Device& device, const std::string& name) const;
  std::string set(Device& device, const std::string& name, const std::string& data);
  static std::vector<std::string> flags(const Device& device, int axis);
  void queueLine(char kind, const Device& device, const std::string& text, double delay);

  ZaberEmulatorConfig config_;
  std::vector<ZaberEmulatedAxis> axes_;
  std::map<int, Device> devices_;  // by number
  std::string line_;
  std::string rejection_;  // for the next command; empty: none
  double time_ = 0;        // s
  int replies_ = 0;
};

}  // namespace microinjection
