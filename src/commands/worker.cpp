#include "commands/worker.h"

#include <malloc.h>
#include <sys/prctl.h>

#include <csignal>

#include "cell/mechanics/symmetric_solver.h"

namespace microinjection {

void prepareWorker(bool ends_with_parent) {
  if (ends_with_parent) prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The solver allocates and releases large blocks in every step: the system need not have them back.
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  SymmetricSolver::useOneThread();  // pieces are solved side by side; more threads only wait for each other
}

}  // namespace microinjection
