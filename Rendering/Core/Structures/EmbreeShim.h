// Embree 3 and Embree 4 under one spelling: only what EmbreeStructure.cpp calls. The versions
// differ in the header's folder, in the name of a query's context and in how it reaches the query.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace hrt
{
namespace embree
{

#if RTC_VERSION_MAJOR >= 4

using QueryContext = RTCRayQueryContext;

inline void initialize(QueryContext& context)
{
  rtcInitRayQueryContext(&context);
}

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& rayHit)
{
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &rayHit, &arguments);
}

inline void occluded(RTCScene scene, QueryContext& context, RTCRay& ray)
{
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}

#else

using QueryContext = RTCIntersectContext;

inline void initialize(QueryContext& context)
{
  rtcInitIntersectContext(&context);
}

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& rayHit)
{
  rtcIntersect1(scene, &context, &rayHit);
}

inline void occluded(RTCScene scene, QueryContext& context, RTCRay& ray)
{
  rtcOccluded1(scene, &context, &ray);
}

#endif

} // namespace embree
} // namespace hrt
