// Nacre: PNG files as tests read them back.
#pragma once

#include "engine/picture/png.hpp"
