#include "operation/console/automatic_injection.h"

#include "operation/console/figures.h"

namespace microinjection {

CommandOffer offerInjection(const SessionView& session, bool there, bool running) {
  CommandOffer result{"Start", "", "the whole injection, from approach to withdrawal", ""};
  if (!there) {
    result.refusal = "/controller/inject does not answer";
  } else if (running) {
    result.refusal = "the injection is under way";
  } else {
    result.refusal = offer(ConsoleCommand::kApproach, session).refusal;
  }
  return result;
}

std::string progressText(const InjectionProgress& progress) {
  std::string text = progress.state;
  // After the last layer the next one has no number.
  if (progress.layer > 0 && progress.layer <= progress.layers)
    text += ", layer " + std::to_string(progress.layer) + " of " + std::to_string(progress.layers);
  if (progress.depth != 0) text += ", " + micro(progress.depth, 1) + " um deep";
  return text + ", " + micro(progress.force, 2) + " uN, " + figure(progress.elapsed, 1, 0) + " s";
}

bool isReached(const std::string& outcome) {
  return outcome == "injected" || outcome == "punctured" || outcome == "indented";
}

std::string outcomeText(const std::string& outcome, const std::string& reason, int punctures, double volume) {
  if (!reason.empty()) return outcome + ": " + reason;
  if (outcome != "injected") return outcome;
  return outcome + ": " + figure(volume, 1e-15, 1) + " pL through " + std::to_string(punctures) +
         (punctures == 1 ? " membrane" : " membranes");
}

}  // namespace microinjection
