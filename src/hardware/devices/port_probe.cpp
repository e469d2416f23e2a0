#include "hardware/devices/port_probe.h"

#include "hardware/devices/known_answers.h"

namespace microinjection {
namespace {

constexpr double kListens = 0.1;          // s, before anything is sent
constexpr int kQuestions = 4;             // of which one is to be answered
constexpr std::size_t kProbeHeard = 256;  // bytes, for a name

}  // namespace

void PortProbe::begin(double time) {
  heard_.clear();
  answer_.clear();
  asked_ = 0;
  due_ = known_before_ ? time : time + kListens;  // a device that may be moving is not listened to
}

PortProbe::Verdict PortProbe::step(const std::string& bytes, double time,
                                   const std::function<void(const std::string&)>& send) {
  if (!asks()) return Verdict::kKnown;
  if (heard_.size() < kProbeHeard) heard_ += bytes;
  answer_ += bytes;
  if (asked_ > 0 && question_.is_answer(answer_)) {
    known_before_ = true;
    return Verdict::kKnown;
  }
  if (time < due_) return Verdict::kAsks;
  if (asked_ >= kQuestions) return judge();
  answer_.clear();
  ++asked_;
  due_ = time + asked_ * question_.patience;  // a slow adapter
  send(question_.request);
  return Verdict::kAsks;
}

PortProbe::Verdict PortProbe::judge() {
  const std::string name = nameOfAnswer(heard_);
  if (known_before_ && (name.empty() || name == question_.device)) return Verdict::kKnown;
  reason_ = name.empty() ? "no reply: is it switched on, and is it the right port?"
                         : name + " answers: is it the right port?";
  reason_ += " Nothing was sent that could move another device";
  return Verdict::kOther;
}

}  // namespace microinjection
