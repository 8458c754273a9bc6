#include "client/sequence/sequence.h"
#include <gtest/gtest.h>
