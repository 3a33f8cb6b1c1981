// Embree 3 and Embree 4 under one spelling: the versions differ in the header's folder. The builder
// (WideTree.cpp) is the same in both.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
