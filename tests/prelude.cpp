#include "tests/prelude.h"
