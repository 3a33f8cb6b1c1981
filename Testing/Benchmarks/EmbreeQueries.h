// Embree's own traversal under one spelling for Embree 3 and Embree 4: what the structures are
// measured against. The versions differ in the name of a query's context and in how it is handed in.
#pragma once

#include "Rendering/Core/Structures/EmbreeShim.h"

namespace hrt
{
namespace bvh
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

inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rayHit)
{
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &rayHit, &arguments);
}

inline void occluded(RTCScene scene, QueryContext& context, const int* valid, RTCRay16& ray)
{
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &ray, &arguments);
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

inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rayHit)
{
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rayHit);
}

inline void occluded(RTCScene scene, QueryContext& context, const int* valid, RTCRay16& ray)
{
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded16(valid, scene, &context, &ray);
}

#endif

} // namespace bvh
} // namespace hrt
