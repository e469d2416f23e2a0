#include "commands/prepare_section_family.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/cache_file.h"
#include "base/errors.h"
#include "base/worker_processes.h"
#include "cell/family/axis_force_ratio.h"
#include "cell/family/family_file.h"
#include "cell/family/next_members.h"
#include "cell/family/pierced_family.h"
#include "cell/family/tongue_member.h"
#include "cell/family/withdrawal_family.h"
#include "commands/family_plan.h"
#include "commands/path_store.h"
#include "commands/run_tasks.h"

namespace microinjection {
namespace {

constexpr int kMembersOfRound = 8;  ///< solved before the next are chosen

/// Of the data of one member, in the cache.
std::string sectionMemberFile(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  const std::string cache = cacheDirectory("section_families");
  if (cache.empty()) throw ConfigError("neither XDG_CACHE_HOME nor HOME is set: no folder for the data");
  return cache + "/" + contentHash(family.description()) + "/member_" + coordinatesText(coordinates, '_');
}

/// What the errors of the first two columns are of; null: there is one only.
std::pair<const char*, const char*> toldOf(SectionFamily::Kind kind) {
  if (kind == SectionFamily::Kind::kTongue) return {"the tongue's rise", "; the end"};
  if (kind == SectionFamily::Kind::kPierced) return {"the whole cell's force", "; the pierced one's, on the way in"};
  if (kind == SectionFamily::Kind::kWithdrawal)
    return {"the way out of half a radius, over the force there", "; of a twentieth"};
  return {"the force", nullptr};
}

SectionMember solveMember(const SectionFamily& family, const Eigen::VectorXd& coordinates) {
  if (family.kind() == SectionFamily::Kind::kTongue) return solveTongue(family, coordinates);
  if (family.kind() == SectionFamily::Kind::kPierced) return solvePierced(family, coordinates);
  if (family.kind() == SectionFamily::Kind::kWithdrawal) return solveWithdrawal(family, coordinates);
  return solveAxisForceRatio(family, coordinates);
}

class SectionPreparation {
 public:
  explicit SectionPreparation(const FamilyArguments& arguments)
      : arguments_(arguments),
        family_(SectionFamily::load(arguments.file)),
        path_(familyDataFile(arguments.file)),
        data_(family_) {
    requireWritableFolder(std::filesystem::absolute(path_).parent_path());
    auto read = SectionFamilyData::load(family_, path_);
    if (read) data_ = std::move(*read.content);
    reportDamage(read.state, read.reason);
  }

  void run() {
    while (count() < arguments_.members) {
      const std::vector<Eigen::VectorXd> round = nextMembers(data_.knownPoints(), data_.covariance().lengths,
                                                             std::min(kMembersOfRound, arguments_.members - count()));
      solve(round);
      for (const Eigen::VectorXd& member : round) add(member);
      data_.update();
      data_.setProvenance(provenance());
      data_.save(path_);
      std::printf("prepare: %s\n", errorsText().c_str());
      std::fflush(stdout);
    }
    std::printf("prepare: family %s: %s\n%s", family_.name().c_str(), path_.c_str(), data_.provenance().c_str());
  }

 private:
  int count() const { return static_cast<int>(data_.members().size() + data_.failed().size()); }

  void solve(const std::vector<Eigen::VectorXd>& members) const {
    runTasks("prepare: from member " + std::to_string(count() + 1), "members", arguments_.jobs, [&] {
      std::vector<Work> commands;
      for (const Eigen::VectorXd& member : members) {
        if (SectionFamilyData::load(family_, sectionMemberFile(family_, member))) continue;
        commands.push_back({{thisProgram(), "--family", arguments_.file, "--at=" + coordinatesText(member, ',')}});
      }
      return commands;
    });
  }

  void add(const Eigen::VectorXd& coordinates) {
    const auto read = SectionFamilyData::load(family_, sectionMemberFile(family_, coordinates));
    if (!read) throw std::runtime_error(read.reason);
    for (const SectionMember& member : read.content->members()) data_.add(member);
    for (const Eigen::VectorXd& failed : read.content->failed()) {
      data_.addFailed(failed);
      std::printf("prepare: the member at %s is left out: %s\n", coordinatesText(failed, ',').c_str(),
                  read.content->provenance().c_str());
    }
  }

  std::string errorsText() const {
    const auto& [first, second] = toldOf(family_.kind());
    std::ostringstream out;
    out.precision(2);
    out << data_.members().size() << " members, " << data_.failed().size() << " left out; each from the others: ";
    const auto say = [&](const char* what, const ExpectedError& error) {
      out << what << ": median " << 100 * error.median << " %, nine of ten below " << 100 * error.common << " %";
    };
    say(first, data_.leaveOneOutError(0));
    if (second) say(second, data_.leaveOneOutError(1));
    return out.str();
  }

  std::string provenance() const {
    std::ostringstream out;
    out << "made by: prepare --family " << std::filesystem::path(arguments_.file).filename().string() << " --members "
        << arguments_.members << "\nversion: " << MICROINJECTION_VERSION << '\n'
        << errorsText() << '\n';
    return out.str();
  }

  FamilyArguments arguments_;
  SectionFamily family_;
  std::string path_;
  SectionFamilyData data_;
};

}  // namespace

void prepareSectionFamily(const FamilyArguments& arguments) {
  const std::string refused = !arguments.list.empty() || !arguments.plan.empty() ? "--list and --plan"
                              : arguments.check > 0                              ? "--check"
                              : arguments.refit                                  ? "--refit"
                                                                                 : "";
  if (!refused.empty()) throw ConfigError(refused + ": a family of sections has none");
  SectionPreparation(arguments).run();
}

void solveSectionMember(const std::string& file, const std::string& coordinates) {
  const SectionFamily family = SectionFamily::load(file);
  const auto parsed = parseCoordinates(coordinates, ',');
  if (!parsed || parsed->size() != family.dimension())
    throw ConfigError("--at = " + coordinates + ": must be " + std::to_string(family.dimension()) + " numbers");
  SectionFamilyData data(family);
  try {
    data.add(solveMember(family, *parsed));
  } catch (const std::runtime_error& error) {
    data.addFailed(*parsed);
    data.setProvenance(error.what());
  }
  const std::string path = sectionMemberFile(family, *parsed);
  requireWritableFolder(std::filesystem::path(path).parent_path());
  data.save(path);
}

}  // namespace microinjection
