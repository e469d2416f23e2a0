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
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/standard_output.h"
#include "rig/devices/rig_registry.h"
#include "rig/serial/emulator_host.h"

namespace microinjection {
namespace {

constexpr char kHelp[] = R"(usage: emulate RIG [OPTION...]

An emulated micromanipulator on a pseudo-terminal, for its driver to be tried without a device.

It is timed as the real one: the line's baud rate, the time to answer, speed and acceleration. It runs until it is interrupted
(Ctrl-C); the driver may come and go. Lines on standard input are further faults, of the same form as --fault.

Faults: KIND[:VALUE][@TIME]; TIME in s since the start, at once without it
  silence:S    for S s it neither hears nor says anything (what moves goes on moving)
  drop:N       the next N bytes that it says are lost
  deaf:N       the next N bytes said to it are lost
  garble:N     the next N bytes that it says arrive with all bits turned over
  error:CODE   its next command is answered with this error: MP-285: 0, or a sum of 1, 2, 4, 8;
               Eppendorf, Scientifica: a number from 0 to 999;
               Zaber: BADDATA, AGAIN, ... (rejection), FS, WT, ... (a warning flag, until it is cleared);
               all: RESET (it was switched off and on: it counts from 0 where it stands, without a reference position,
               with the settings of delivery)
  interrupt    what moves is stopped as if by hand

Exit status: 0 interrupted; 2 bad usage, a terminal or link that cannot be made, or output that cannot be written.
)";

volatile std::sig_atomic_t interrupted = 0;

struct Arguments {
  const Rig* rig = nullptr;
  std::string link;
  int baud = 0;  // bit/s
  std::vector<Fault> faults;
  std::string positions;  // path; empty: not written
  std::string firmware;   // empty: the emulator's own
  bool verbose = false;
};

std::string rigNames() {
  std::string names;
  for (const Rig& rig : rigs()) names += (names.empty() ? "" : " or ") + rig.name;
  return names;
}

/// Nothing when help was asked for and given. What roslaunch adds (__name:=..., FROM:=TO) is left out.
std::optional<Arguments> parse(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  std::string rig;
  std::vector<std::string> words, faults;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]).find(":=") == std::string::npos) words.emplace_back(argv[i]);
  }
  po::options_description options("Options");
  auto add = options.add_options();
  add("help,h", "this text");
  add("rig", po::value(&rig)->value_name("NAME"), (rigNames() + "; the option's name may be left out").c_str());
  add("link", po::value(&arguments.link)->value_name("PATH"),
      "link to the terminal: the port of the driver's configuration (/tmp/emulated_RIG)");
  add("baud", po::value(&arguments.baud)->value_name("N"), "bit/s (as the device is delivered)");
  add("fault", po::value(&faults)->composing()->value_name("SPEC"), "a fault, as above; may be repeated");
  add("positions", po::value(&arguments.positions)->value_name("FILE"),
      "writes time_s,x_m,y_m,z_m there: where the axes truly are, whenever that changes; time since the start");
  add("firmware", po::value(&arguments.firmware)->value_name("VERSION"),
      "the version of its firmware, e.g. 6.28, where the device tells one");
  add("verbose,v", po::bool_switch(&arguments.verbose), "prints what is heard (>) and said (<)");
  po::variables_map given;
  try {
    po::positional_options_description first;
    po::store(po::command_line_parser(words).options(options).positional(first.add("rig", 1)).run(), given);
    po::notify(given);
  } catch (const po::error& error) {
    throw ConfigError(error.what());
  }
  if (given.count("help")) {
    std::cout << kHelp << '\n' << options;
    flushStandardOutput();
    return std::nullopt;
  }
  if (rig.empty()) throw ConfigError("RIG is missing: must be " + rigNames());
  arguments.rig = &findRig(rig);
  if (!given.count("link")) arguments.link = "/tmp/emulated_" + rig;
  if (!given.count("baud")) arguments.baud = arguments.rig->default_baud;
  if (arguments.baud <= 0) throw ConfigError("--baud = " + std::to_string(arguments.baud) + ": must be > 0 bit/s");
  for (const std::string& fault : faults) arguments.faults.push_back(parseFault(fault));
  return arguments;
}

/// Bytes as they are where they can be read, otherwise as \xNN.
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

/// Complete lines that have come on standard input; does not wait.
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

/// What went over the line, a row a direction; bytes that follow each other closely are one row.
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

/// Where the device truly is, a row each time that it has moved.
class Positions {
 public:
  /// No `path`: writes nothing. @throws ConfigError when the file cannot be written.
  explicit Positions(const std::string& path) {
    if (path.empty()) return;
    file_.open(path);
    if (!(file_ << "time_s,x_m,y_m,z_m" << std::endl)) {
      throw ConfigError("--positions = " + path + ": must be a file that can be written");
    }
  }
  void add(const Eigen::Vector3d& place, double time) {
    if (!file_.is_open() || place == last_) return;
    last_ = place;
    char row[128];
    std::snprintf(row, sizeof(row), "%.4f,%.9f,%.9f,%.9f", time, place.x(), place.y(), place.z());
    file_ << row << std::endl;  // at once, so that it may be read while the device moves
  }

 private:
  std::ofstream file_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Constant(std::nan(""));  // m
};

/// A device does not wait for the processor, as its driver's node in real time would have it do. Where the system does
/// not allow it nothing changes.
void runInRealTime() {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_min(SCHED_RR) + 1;
  sched_setscheduler(0, SCHED_RR, &parameters);
}

void serve(const Arguments& arguments) {
  const Rig& rig = *arguments.rig;
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
  try {
    const std::optional<Arguments> arguments = parse(argc, argv);
    if (!arguments) return 0;
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { interrupted = 1; });
    runInRealTime();
    serve(*arguments);
    return 0;
  } catch (const std::exception& exception) {
    std::cerr << "emulate: " << exception.what() << '\n';
    return 2;
  }
}
