#pragma once

#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace microinjection {

/// What to do about the reasons that nodes give, read from doc/guide/troubleshooting.md: that page is for people and
/// for programs, so that both say the same.
///
/// An item of a list, or a paragraph, begins with the reasons that it is about, in backticks; what follows is the
/// remedy. In a reason N stands for a number, NAME, TOPIC and KEY for a name, and `...` for anything. A reason in the
/// middle of an item has the remedy of the item.
class Remedies {
 public:
  struct Remedy {
    std::string text;     ///< without marks of Markdown; empty: the page has the reason and no more
    std::string section;  ///< heading
  };

  /// Of a page.
  explicit Remedies(const std::string& markdown);
  /// Of the page that this program was built with.
  static const Remedies& builtIn();

  /// That of the pattern with the most letters in common; none: no pattern is of this reason.
  std::optional<Remedy> of(const std::string& reason) const;
  /// Each pattern, as the page has it.
  std::vector<std::string> patterns() const;

 private:
  struct Entry {
    std::string pattern;
    std::regex expression;
    std::size_t letters;  ///< that are no placeholders
    Remedy remedy;
  };
  void addItem(const std::string& item, const std::string& section);
  void addPattern(const std::string& pattern, const Remedy& remedy);

  std::vector<Entry> entries_;
};

}  // namespace microinjection
