"""Inverse reachability: base poses from which a robot reaches a pose."""

from ravemj.compat.databases.model import DatabaseGenerator
from ravemj.compat.refusal import lacking, refusing

REACH = "maps of what arms reach"


@lacking(
    REACH,
    """
    computeAggregateBaseDistribution(Tgrasps logllthresh zaxis) computeBaseDistribution(Tgrasp logllthresh zaxis)
    generate(heightthresh quatthresh Nminimum) getCloseIK(Tgrasp) getEquivalenceClass(Tgrasp) necessaryjointstate()
    randomBaseDistributionIterator(Tgrasps Nprematuresamples bounds **named)
    sampleBaseDistributionIterator(Tgrasps logllthresh weight Nprematuresamples zaxis) show(options)
    showEquivalenceClass(equivalenceclass transparency neighthresh onlymaniplinks)
    testEquivalenceClass(equivalenceclass) testSampling(heights N weight **named)
    @classnormalizationconst(classstd) @getManipulatorLinks(manip) @getdofindices(manip)
    @showBaseDistribution(env densityfn bounds zoffset thresh maxprob marginalizeangle)
    """,
)
class InverseReachabilityModel(DatabaseGenerator):
    """Base poses from which a robot reaches a pose."""

    capability = REACH


run = refusing("inversereachability.run", REACH, "*arguments **named")
