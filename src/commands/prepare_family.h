#pragma once

#include <string>

namespace microinjection {

struct FamilyArguments {
  std::string file;  ///< of the family, YAML
  int jobs = 1;
  int members = 30;  ///< to have at the end
  bool members_given = false;
  int check = 0;          ///< members to draw and solve, instead
  bool refit = false;     ///< first fits the members anew to the forces that the data keep
  bool record = false;    ///< the check's errors become those that the family expects
  int seed = 1;           ///< of the draw
  std::string csv;        ///< of the check's table; empty for none
  std::string list;       ///< file for the tasks of the next round, instead
  std::string plan;       ///< such a file: a task of it is solved, or its results are gathered
  std::string reference;  ///< file of the check's solutions, read and completed; empty for none
};

/// Solves members of a family until there are so many, and stores the family's data beside its file
/// (.data for .yaml). Continues from members and paths that are there; several processes share the
/// work. With `list` it only lists the tasks of the next round; with `plan` it adds the members of a
/// round whose tasks are done. Data to which nothing is added stay as they are. Throws ConfigError, WriteError and
/// std::runtime_error with messages for the user.
void prepareFamily(const FamilyArguments& arguments);

/// Solves tasks of arguments.plan from `first` on. Exit status: 0, or kBusyStatus when another
/// process is solving one of them.
int solveFamilyTasks(const FamilyArguments& arguments, int first, int count);

/// Solves members that the family has not, at random coordinates, and prints how far its forces are
/// off.
void checkFamily(const FamilyArguments& arguments);

/// Solves one path of the member at `coordinates` (text, with commas), as a worker process. Exit
/// status: 0, or kBusyStatus.
int solveFamilyPath(const std::string& file, const std::string& coordinates, int ray);

/// Solves one node of the family's grid of forces on the axis, as a worker process.
void solveAxisNode(const std::string& file, int node);

/// Same as solveFamilyPath, for a path of the check's member.
int solveCheckPath(const FamilyArguments& arguments, int member, int ray);

}  // namespace microinjection
