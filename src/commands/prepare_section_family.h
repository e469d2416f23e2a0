#pragma once

#include <string>

#include "commands/prepare_family.h"

namespace microinjection {

/// Solves members of a SectionFamily and stores its data beside its file. Throws as prepareFamily().
void prepareSectionFamily(const FamilyArguments& arguments);

/// Solves the member at these coordinates and stores it in the cache, as a worker process.
void solveSectionMember(const std::string& file, const std::string& coordinates);

}  // namespace microinjection
