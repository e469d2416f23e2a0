#include "hardware/serial/emulator.h"

#include <algorithm>

namespace microinjection {

void DeviceEmulator::inject(const Fault& fault) {
  if (fault.kind == Fault::Kind::kError) checkError(fault.code);
  pending_.push_back(fault);
}

void DeviceEmulator::beginFaults(double time) {
  std::vector<Fault> later;
  for (const Fault& fault : pending_) {
    if (fault.time > time) {
      later.push_back(fault);
      continue;
    }
    const int bytes = static_cast<int>(std::min(fault.amount, 1e6));
    switch (fault.kind) {
      case Fault::Kind::kSilence:
        silent_until_ = std::max(silent_until_, time + fault.amount);
        break;
      case Fault::Kind::kDrop:
        to_drop_ += bytes;
        break;
      case Fault::Kind::kDeaf:
        to_miss_ += bytes;
        break;
      case Fault::Kind::kGarble:
        to_garble_ += bytes;
        break;
      case Fault::Kind::kError:
        failNextCommand(fault.code);
        break;
      case Fault::Kind::kInterrupt:
        interrupt(time);
        break;
    }
  }
  pending_.swap(later);
}

void DeviceEmulator::receive(const std::string& bytes, double time) {
  beginFaults(time);
  const std::size_t missed = std::min<std::size_t>(bytes.size(), to_miss_);
  to_miss_ -= static_cast<int>(missed);
  if (time >= silent_until_ && missed < bytes.size()) process(bytes.substr(missed), time);
}

std::string DeviceEmulator::produce(double time) {
  advance(time);
  std::string output;
  const auto end = replies_.upper_bound(time);
  for (auto each = replies_.begin(); each != end; each = replies_.erase(each)) output += each->second;
  return output;
}

std::string DeviceEmulator::send(double time) {
  beginFaults(time);
  std::string output = produce(time);
  if (time < silent_until_) return "";
  const std::size_t dropped = std::min<std::size_t>(output.size(), to_drop_);
  to_drop_ -= static_cast<int>(dropped);
  output.erase(0, dropped);
  for (char& byte : output) {
    if (to_garble_ == 0) break;
    byte = static_cast<char>(~byte);
    --to_garble_;
  }
  return output;
}

}  // namespace microinjection
