#include "hardware/injector/line_dialogue.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace microinjection {
namespace {

constexpr std::size_t kLongestLine = 256;  // bytes

}  // namespace

LineDialogue::LineDialogue(Wire& wire, const Framing& framing)
    : wire_(wire), framing_(framing), lines_(framing.reply_end, kLongestLine) {}

void LineDialogue::resynchronize(double time) {
  in_step_ = waiting_ = false;
  last_received_ = time;
}

void LineDialogue::send(const std::string& line, double timeout, double time) {
  sent_ = line;
  waiting_ = true;
  echoed_ = false;
  deadline_ = time + timeout;
  wire_.write(line + framing_.send_end, time);
}

LineDialogue::Result LineDialogue::receive(double time) {
  const std::string bytes = wire_.read(time);
  if (!bytes.empty()) last_byte_ = time;
  const unsigned too_long = lines_.tooLong();
  std::vector<std::string> lines = lines_.feed(bytes);
  for (std::string& line : lines) {
    if (framing_.reply_end == "\n" && !line.empty() && line.back() == '\r') line.pop_back();
  }
  lines.erase(std::remove_if(lines.begin(), lines.end(), [this](const auto& line) { return ignores(line); }),
              lines.end());
  const bool noise = framing_.ignore ? !lines.empty() || lines_.tooLong() > too_long : !bytes.empty();
  if (noise) last_received_ = time;
  if (!in_step_) {
    if (!quiet(time)) return Result::kNone;
    lines_.clear(false);
    in_step_ = true;
    return Result::kNone;
  }
  int replies = 0;
  for (std::string& line : lines) {
    if (echoes(line)) continue;
    reply_ = std::move(line);
    ++replies;
  }
  const bool was_waiting = waiting_;
  if (replies > (was_waiting ? 1 : 0) || lines_.tooLong() > too_long) {
    bad_ += static_cast<unsigned>(replies);
    resynchronize(time);
    return was_waiting ? Result::kUnclear : Result::kNone;
  }
  if (replies == 1) {
    waiting_ = false;
    return Result::kReply;
  }
  if (!was_waiting || time <= deadline_) return Result::kNone;
  resynchronize(time);
  return Result::kLate;
}

bool LineDialogue::ignores(const std::string& line) const {
  return framing_.ignore && std::regex_match(line, *framing_.ignore);
}

bool LineDialogue::echoes(const std::string& line) {
  if (!framing_.echo || !waiting_ || echoed_ || !(line.empty() || line == sent_)) return false;
  echoed_ = true;
  return true;
}

}  // namespace microinjection
