#include "accuracy/collision/adapter.h"

namespace tendril::suite {

Adapter tendril_adapter();
Adapter tendril_doubles_adapter();
Adapter plain_adapter();
Adapter cgal_adapter();
Adapter fcl_adapter();
Adapter gts_adapter();
Adapter ccd_adapter();
Adapter embree_adapter();
Adapter bullet_adapter();
Adapter ode_adapter();

std::vector<Adapter> adapters() {
  return {
      tendril_adapter(), tendril_doubles_adapter(), plain_adapter(),
#ifdef TENDRIL_SUITE_CGAL
      cgal_adapter(),
#endif
#ifdef TENDRIL_SUITE_FCL
      fcl_adapter(),
#endif
#ifdef TENDRIL_SUITE_GTS
      gts_adapter(),
#endif
#ifdef TENDRIL_SUITE_CCD
      ccd_adapter(),
#endif
#ifdef TENDRIL_SUITE_EMBREE
      embree_adapter(),
#endif
#ifdef TENDRIL_SUITE_BULLET
      bullet_adapter(),
#endif
#ifdef TENDRIL_SUITE_ODE
      ode_adapter(),
#endif
  };
}

}  // namespace tendril::suite
