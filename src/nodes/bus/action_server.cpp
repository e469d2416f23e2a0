#include "nodes/bus/action_server.h"

#include <sstream>

namespace microinjection {

std::string aheadOfTime(const ros::Time& stamp, const ros::Time& now) {
  if (now.isZero() || !isAhead(stamp, now)) return "";
  std::ostringstream text;
  text << "its stamp is " << secondsBetween(now, stamp) << " s ahead of the time, allowed " << kLargestLead << " s";
  return text.str();
}

}  // namespace microinjection
