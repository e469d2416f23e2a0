#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// One line of a laboratory's notebook: a cell that the needle has touched, and what came of it. Values
/// that nobody knows are empty.
struct NotebookEntry {
  struct Estimate {
    double value = 0, low = 0, high = 0;
  };
  std::string time;                        ///< local date and time at the end, ISO 8601
  std::string cell;                        ///< name of the session's scene
  std::optional<double> diameter;          ///< m, of the served cell
  std::optional<Estimate> modulus;         ///< Pa, estimated; 95 %
  std::string verdict;                     ///< of the estimate
  std::optional<Estimate> expected_depth;  ///< m, of the puncture, at half of its depth
  std::optional<Estimate> expected_force;  ///< N
  std::optional<double> puncture_depth;    ///< m, met
  std::optional<double> puncture_force;    ///< N, met
  double peak_force = 0;                   ///< N, along the pipette
  double deepest = 0;                      ///< m, past the contact point
  unsigned punctures = 0;
  double volume = 0;    ///< m^3, injected
  std::string outcome;  ///< of the controller's injection; by_hand without one
  std::string reason;   ///< of that outcome
};

/// First line of a notebook, with its line break.
extern const char* const kNotebookHeader;

/// The entry as a line of comma-separated values; texts are quoted where they need it (RFC 4180).
std::string toLine(const NotebookEntry& entry);

/// Adds an entry to the file, which is created with its folders. Throws std::runtime_error, and leaves
/// the file as it was, when it cannot be written or is no notebook.
void appendToNotebook(const std::string& path, const NotebookEntry& entry);

}  // namespace microinjection
