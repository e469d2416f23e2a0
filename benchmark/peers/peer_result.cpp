#include "benchmark/peers/peer_result.h"

#include <sstream>

namespace microinjection {

std::string peerResultText(const PeerResult& result) {
  std::ostringstream text;
  text.precision(17);
  text << "peer_result 1\nprogram " << result.program << "\nmodel " << result.model << "\nelement " << result.element
       << "\nlaw " << result.law << '\n';
  if (result.declined.empty()) {
    text << "steps " << result.steps.size() << '\n';
    for (const PeerResult::Step& step : result.steps) {
      text << step.force.x() << ' ' << step.force.y() << ' ' << step.force.z() << ' ' << step.time << '\n';
    }
  } else {
    text << "declined " << result.declined << '\n';
  }
  text << "end\n";
  return text.str();
}

}  // namespace microinjection
