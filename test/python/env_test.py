#!/usr/bin/python3
"""Environments: the interface of gymnasium without it, the same again with the same seed, vectorised."""
import importlib.util
import types
import unittest
import unittest.mock

import numpy

import fmbpc

LOOP = ("asp_case1", {"sampling.duration_h": 3})


def make(**more):
    return fmbpc.env(LOOP[0], set=LOOP[1], **more)


class Envs(unittest.TestCase):
    def episode(self, env, seed, actions=None):
        rng = numpy.random.default_rng(1)
        observation, _ = env.reset(seed=seed)
        seen, rewards, ended = [observation], [], False
        while not ended:
            observation, reward, terminated, truncated, info = env.step(rng.uniform(env.action_space.low, env.action_space.high))
            seen.append(observation)
            rewards.append(reward)
            ended = terminated or truncated
        return numpy.array(seen), rewards

    def test_a_seed_gives_the_same_episode_again_and_another_another(self):
        env = make()
        first, rewards = self.episode(env, 1)
        again, _ = self.episode(make(), 1)
        other, _ = self.episode(env, 2)
        back, _ = self.episode(env, 1)
        numpy.testing.assert_array_equal(first, again)
        numpy.testing.assert_array_equal(first, back)
        self.assertTrue((first != other).any())
        self.assertTrue(all(r <= 0.0 for r in rewards))

    def test_observations_lie_in_their_space(self):
        env = make()
        observation, info = env.reset(seed=3)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertTrue(env.action_space.contains(env.action_space.sample()))
        self.assertEqual(0.0, info["time_h"])

    def test_wrong_actions_and_a_step_after_the_end_are_refused(self):
        env = make()
        with self.assertRaises(fmbpc.InputError):
            env.step([500.0])
        env.reset()
        for wrong in ([numpy.nan], [1.0, 2.0], None, ["a"]):
            with self.assertRaises(fmbpc.InputError):
                env.step(wrong)
        for wrong in ("a", 1.5, -1, True):
            with self.assertRaisesRegex(fmbpc.InputError, "seed"):
                env.reset(seed=wrong)
        for wrong in (3, [], "12"):
            with self.assertRaisesRegex(fmbpc.InputError, "seeds"):
                make(seeds=wrong)
        self.episode(env, None)
        with self.assertRaises(fmbpc.InputError):
            env.step([500.0])

    def test_seeds_step_together_as_alone(self):
        env, alone = make(seeds=[1, 2]), make()
        observations, _ = env.reset()
        self.assertEqual(2, len(observations))
        for k, seed in enumerate((1, 2)):
            numpy.testing.assert_array_equal(alone.reset(seed=seed)[0], observations[k])
        for _ in range(40):  # over the end, where each begins anew
            observations, rewards, _, truncated, _ = env.step([[500.0], [600.0]])
        self.assertEqual((2,), rewards.shape)
        with self.assertRaises(fmbpc.InputError):
            env.step([[500.0]])

    def test_a_reward_of_ones_own(self):
        env = make(reward=lambda y, setpoint, u, move: 7.0)
        env.reset()
        self.assertEqual(7.0, env.step([500.0])[1])

    def test_reset_seeds_the_base_class_where_gymnasium_is(self):
        """What its checker asks, with a class in the place of gymnasium's own."""
        class Base:
            seeds = []

            def reset(self, *, seed=None, options=None):
                self.seeds.append(seed)
        stand_in = types.SimpleNamespace(Env=Base, spaces=types.SimpleNamespace(Box=lambda low, high, dtype: fmbpc._env.Box(low, high)))
        with unittest.mock.patch.dict("sys.modules", gymnasium=stand_in):
            env = make()
            env.reset(seed=7)
            env.reset()
        self.assertIsInstance(env, Base)
        self.assertEqual([7, None], Base.seeds)

    @unittest.skipUnless(importlib.util.find_spec("gymnasium"), "gymnasium is not installed")
    def test_the_checker_of_gymnasium_passes(self):
        from gymnasium.utils.env_checker import check_env
        for name in (LOOP[0], "mimo_cstr_steps", "heated_tank", "cstr_tracking"):
            with self.subTest(name):
                check_env(fmbpc.env(name), skip_render_check=True)


if __name__ == "__main__":
    unittest.main()
