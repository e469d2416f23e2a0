#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <unistd.h>

#include <boost/program_options.hpp>
#include <cctype>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/standard_output.h"
#include "hardware/devices/driver_registry.h"
#include "hardware/serial/emulator_host.h"

namespace microinjection {
namespace {

constexpr char kHelp[] = R"(usage: emulate RIG [OPTION...]

Emulates a micromanipulator on a pseudo-terminal, to test its driver without a device.

The emulator has the real device's baud rate, reply time, speed and acceleration. It runs until it is interrupted
(Ctrl-C). Drivers may connect and disconnect. Lines on standard input inject further faults, in the form of --fault.

Faults: KIND[:VALUE][@TIME]; TIME in s since the start, default 0
  silence:S    for S s the device neither receives nor sends (a motion continues)
  drop:N       the next N bytes from the device are lost
  deaf:N       the next N bytes to the device are lost
  garble:N     the next N bytes from the device arrive with all bits inverted
  error:CODE   the reply to the next command is this error: MP-285: 0, or a sum of 1, 2, 4, 8;
               Eppendorf, Scientifica, Sensapex: a number from 0 to 999;
               Zaber: BADDATA, AGAIN, ... (rejection), FS, WT, ... (a warning flag, until it is cleared);
               all: RESET (switched off and on: it counts from 0 at its position, without a reference position,
               with the factory settings)
  interrupt    stops a motion, as an operator at the device would

Exit status: 0 interrupted; 2 bad usage, a terminal or link that cannot be made, or output that cannot be written.
)";

volatile std::sig_atomic_t interrupted = 0;

struct Arguments {
  const DriverEntry* rig = nullptr;
  std::string link;
  int baud = 0;  // bit/s
  std::vector<Fault> faults;
  std::string positions;  // path; empty: not written
  std::string firmware;   // empty: the emulator's own
  bool verbose = false;
};

std::string rigNames() {
  std::string names;
  for (const DriverEntry& rig : driverEntries()) names += (names.empty() ? "" : " or ") + rig.name;
  return names;
}

/// Returns nothing after printing the help. Ignores the arguments that roslaunch adds (__name:=...,
/// FROM:=TO).
std::optional<Arguments> parse(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  std::string rig;
  std::vector<std::string> own_arguments, faults;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]).find(":=") == std::string::npos) own_arguments.emplace_back(argv[i]);
  }
  po::options_description options("Options");
  auto add = options.add_options();
  add("help,h", "this text");
  add("rig", po::value(&rig)->value_name("NAME"), (rigNames() + "; the option's name may be left out").c_str());
  add("link", po::value(&arguments.link)->value_name("PATH"),
      "link to the terminal: the port of the driver's configuration (/tmp/emulated_RIG)");
  add("baud", po::value(&arguments.baud)->value_name("N"), "bit/s (default: the factory setting)");
  add("fault", po::value(&faults)->composing()->value_name("SPEC"), "a fault, as above; may be repeated");
  add("positions", po::value(&arguments.positions)->value_name("FILE"),
      "writes time_s,x_m,y_m,z_m: the true position of the axes after each motion; time since the start");
  add("firmware", po::value(&arguments.firmware)->value_name("VERSION"),
      "firmware version that the device reports, e.g. 6.28");
  add("verbose,v", po::bool_switch(&arguments.verbose), "prints the bytes received (>) and sent (<)");
  po::variables_map given;
  if (!readCommandLine(own_arguments, options, std::string(kHelp) + '\n', given, "rig")) return std::nullopt;
  if (rig.empty()) throw ConfigError("RIG is missing: must be " + rigNames());
  arguments.rig = &findDriver(rig);
  if (!given.count("link")) arguments.link = "/tmp/emulated_" + rig;
  if (!given.count("baud")) arguments.baud = arguments.rig->default_baud;
  if (arguments.baud <= 0) throw ConfigError("--baud = " + std::to_string(arguments.baud) + ": must be > 0 bit/s");
  for (const std::string& fault : faults) arguments.faults.push_back(parseFault(fault));
  return arguments;
}

/// Replaces bytes that are not printable by \xNN.
std::string visible(const std::string& bytes) {
  std::string text;
  for (const char each : bytes) {
    char code[8];
    std::snprintf(code, sizeof(code), std::isprint(static_cast<unsigned char>(each)) ? "%c" : "\\x%02x",
                  static_cast<unsigned char>(each));
    text += code;
  }
  return text;
}

/// Complete lines from standard input. Does not block.
class Lines {
 public:
  std::vector<std::string> read() {
    std::vector<std::string> lines;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    while (open_ && ::poll(&input, 1, 0) > 0) {
      char each = 0;
      open_ = ::read(STDIN_FILENO, &each, 1) == 1;
      if (open_ && each != '\n') {
        text_ += each;
      } else if (!text_.empty()) {
        lines.push_back(text_);
        text_.clear();
      }
    }
    return lines;
  }

 private:
  bool open_ = true;
  std::string text_;
};

/// Bytes on the line, one row a direction. Bytes that follow each other within 20 ms share a row.
class Transcript {
 public:
  void add(char direction, const std::string& bytes, double time) {
    if (!text_.empty() && (direction != direction_ || time - last_ > 0.02)) flush();
    if (bytes.empty()) return;
    if (text_.empty()) begin_ = time;
    direction_ = direction;
    last_ = time;
    text_ += visible(bytes);
  }
  void flush() {
    if (!text_.empty()) std::printf("%9.3f %c %s\n", begin_, direction_, text_.c_str());
    flushStandardOutput();
    text_.clear();
  }

 private:
  char direction_ = ' ';
  double begin_ = 0, last_ = 0;  // s
  std::string text_;
};

/// Table of the device's true position, with a row after each motion.
class Positions {
 public:
  /// Writes nothing when `path` is empty. @throws ConfigError when the file cannot be written.
  explicit Positions(const std::string& path) {
    if (path.empty()) return;
    file_.open(path);
    if (!(file_ << "time_s,x_m,y_m,z_m" << std::endl)) {
      throw ConfigError("--positions = " + path + ": must be a file that can be written");
    }
  }
  void add(const Eigen::Vector3d& position, double time) {
    if (!file_.is_open() || position == last_) return;
    last_ = position;
    char row[128];
    std::snprintf(row, sizeof(row), "%.4f,%.9f,%.9f,%.9f", time, position.x(), position.y(), position.z());
    file_ << row << std::endl;  // flushes each row, so that others can read it while the device moves
  }

 private:
  std::ofstream file_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Constant(std::nan(""));  // m
};

/// A real device does not wait for a processor, so the emulator asks for real-time scheduling. If
/// the system refuses it, nothing changes.
void runInRealTime() {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_RR) + 1;
  sched_setscheduler(0, SCHED_RR, &parameters);
}

void serve(const Arguments& arguments) {
  const DriverEntry& rig = *arguments.rig;
  const std::shared_ptr<ManipulatorEmulator> device = rig.make_emulator();
  for (const Fault& fault : arguments.faults) device->inject(fault);
  if (!arguments.firmware.empty()) device->setFirmware(arguments.firmware);
  Positions positions(arguments.positions);
  EmulatorHost host(device, arguments.baud, arguments.link);
  std::printf("emulate: %s at %s, %d baud\n", rig.name.c_str(), arguments.link.c_str(), arguments.baud);
  flushStandardOutput();
  Lines lines;
  Transcript transcript;
  const auto start = std::chrono::steady_clock::now();
  while (!interrupted) {
    const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const EmulatorHost::Exchange exchange = host.step(time);
    if (arguments.verbose) {
      if (!exchange.received.empty()) transcript.add('>', exchange.received, time);
      transcript.add('<', exchange.sent, time);
    }
    positions.add(device->position(), time);
    for (const std::string& line : lines.read()) {
      try {
        device->inject(parseFault(line));
      } catch (const ConfigError& error) {
        std::fprintf(stderr, "emulate: %s\n", error.what());
      }
    }
    ::usleep(500);  // us: half a driver's step
  }
  transcript.flush();
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  return runProgram("emulate", [&] {
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments) return kDone;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { interrupted = 1; });
    runInRealTime();
    serve(*arguments);
    return kDone;
  });
}
