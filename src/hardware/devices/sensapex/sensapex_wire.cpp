#include "hardware/devices/sensapex/sensapex_wire.h"

#include <sstream>
#include <utility>

namespace microinjection {
namespace {

/// A stop has a number of its own, so that it has the same bytes whoever sends it.
constexpr std::uint16_t kStopNumber = 0xffff;

std::vector<std::int32_t> integersIn(std::istringstream& words) {
  std::vector<std::int32_t> numbers;
  for (std::int32_t each = 0; words >> each;) numbers.push_back(each);
  return numbers;
}

}  // namespace

SensapexWire::SensapexWire(std::unique_ptr<Wire> wire, std::uint16_t device)
    : wire_(std::move(wire)), device_(device), parser_(device) {}

void SensapexWire::setGuardedStop(const std::string& line) {
  wire_->setGuardedStop(sensapexBytes(request(line.substr(0, line.find('\r')))));
}

SensapexMessage SensapexWire::request(const std::string& line) {
  using Message = SensapexMessage;
  std::istringstream words(line);
  std::string verb;
  words >> verb;
  Message message;
  message.receiver = device_;
  message.sender = Message::kPc;
  message.options = Message::kRequest;
  if (verb == "STOP") {
    message.type = Message::kStop;
    message.number = kStopNumber;
    message.options |= Message::kWantsAcknowledgement;
    return message;
  }
  number_ = static_cast<std::uint16_t>(number_ % (kStopNumber - 1) + 1);
  message.number = number_;
  if (verb == "GOTO") {
    const std::vector<std::int32_t> numbers = integersIn(words);
    message.type = Message::kGoTo;
    message.options |= Message::kWantsAcknowledgement;
    // A device that knows no second block takes the one speed of the first.
    std::int32_t fastest = numbers.at(3);
    for (const std::int32_t each : {numbers.at(4), numbers.at(5)}) {
      const bool faster = each > 0 ? each > fastest : fastest < 0 && each < fastest;
      if (faster) fastest = each;
    }
    message.blocks = {{numbers[0], numbers[1], numbers[2], Message::kUndefined, fastest, Message::kSimultaneous},
                      {numbers[3], numbers[4], numbers[5]}};
    return message;
  }
  message.options |= Message::kWantsResponse;
  message.type = verb == "POS" ? Message::kGetPositions : Message::kGetParameter;
  if (verb == "AXES") message.blocks = {{Message::kAxisCount}};
  return message;
}

void SensapexWire::write(const std::string& lines, double time) {
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line, '\r');) {
    if (line.empty()) continue;
    if (line == "WATCH") started_ = false;
    if (line == "WATCH" || line == "HELLO") {
      local_ += started_ ? "lost\r" : "kept\r";
      continue;
    }
    pending_ = request(line);
    wire_->write(sensapexBytes(*pending_), time);
  }
}

std::string SensapexWire::read(double time) {
  const int malformed = parser_.malformed();
  std::string said = std::exchange(local_, "");
  for (const SensapexMessage& message : parser_.feed(wire_->read(time), time)) {
    if (message.has(SensapexMessage::kNotification)) {
      started_ = started_ || message.type == SensapexMessage::kHello;
      continue;
    }
    said += replyTo(message);
  }
  return parser_.malformed() > malformed ? said + "?\r" : said;
}

/// The line of a reply to the pending request; nothing if it is none.
std::string SensapexWire::replyTo(const SensapexMessage& message) {
  const bool expected = pending_ && message.receiver == SensapexMessage::kPc && message.number == pending_->number &&
                        message.type == pending_->type && !message.has(SensapexMessage::kRequest);
  if (!expected) return "";
  const bool wants_response = pending_->has(SensapexMessage::kWantsResponse);
  if (message.has(SensapexMessage::kAcknowledgement) && wants_response && !message.has(SensapexMessage::kError))
    return "";
  pending_.reset();
  if (message.has(SensapexMessage::kError)) return "E\r";
  if (!wants_response) return message.has(SensapexMessage::kAcknowledgement) ? "A\r" : "?\r";
  std::vector<std::int32_t> numbers;
  if (message.blocks.size() == 1) numbers = message.blocks[0];
  const bool parameter = message.type == SensapexMessage::kGetParameter;
  if (parameter && (numbers.size() != 2 || numbers[0] != SensapexMessage::kAxisCount)) return "?\r";
  if (parameter) return std::to_string(numbers[1]) + "\r";
  std::string line;
  for (const std::int32_t each : numbers) line += (line.empty() ? "" : "\t") + std::to_string(each);
  return line + "\r";
}

}  // namespace microinjection
