"""A ball on a rail, pulled at 0.9 and 1.6 of friction's limit: its speed, its rise over a step's slip."""

import pydrake.all as d

for kind, pull in [(kind, pull) for kind in ("sap", "similar", "lagged", "tamsi") for pull in (0.9, 1.6)]:
    config = d.MultibodyPlantConfig(time_step=0.001, discrete_contact_approximation=kind)
    plant, _ = d.AddMultibodyPlant(config, builder := d.DiagramBuilder())
    d.Parser(plant).AddModelsFromString("""<mujoco model="m"><worldbody><geom type="plane" size="1 1 1" friction=".5"/>
      <body name="ball" pos="0 0 .05"><inertial mass=".3" pos="0 0 0" diaginertia="1 1 1"/><joint type="slide" axis="1 0 0"/>
      <joint type="slide" axis="0 0 1"/><geom size=".05" friction=".5"/></body></worldbody></mujoco>""", "xml")
    plant.Finalize()
    simulator = d.Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    plant.get_applied_generalized_force_input_port().FixValue(context, [pull * 0.5 * 0.3 * 9.81, 0])
    simulator.AdvanceTo(1.0)
    speed, z = plant.GetVelocities(context)[0], plant.GetPositions(context)[1]
    print(f"{kind} {pull}: {1e6 * speed:.3g} um/s, rise {max(0, z) / (1e-3 * speed):.2f} (Coulomb: 0 and 2.943e6, 0)")
